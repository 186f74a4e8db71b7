// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/sandbox/pulse.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>

namespace farm {
namespace {

namespace fs = std::filesystem;

constexpr double longest_look = 1; ///< seconds that one look may stand for
constexpr double around = 0.03;    ///< of the time, for looking around

/// Of processes and their threads together.
struct Doings {
	double spent = 0;   ///< seconds of processor time
	bool asleep = true; ///< all of them
};

/// The fields of a `stat` after the name, which may hold anything; the first is the state.
std::istringstream stat_of(const fs::path& folder) {
	std::ifstream in(folder / "stat");
	const std::string text{std::istreambuf_iterator<char>(in), {}};
	const size_t end = text.rfind(") ");
	return std::istringstream(end == std::string::npos ? "" : text.substr(end + 2));
}

void add(pid_t process, Doings& all) {
	const fs::path folder = "/proc/" + std::to_string(process);
	std::istringstream own = stat_of(folder);
	std::string skipped;
	for (int i = 0; i < 11; ++i)
		own >> skipped;
	double user = 0, system = 0;
	own >> user >> system;
	all.spent += (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
	std::error_code gone;
	fs::directory_iterator at(folder / "task", gone);
	// What cannot be seen, because it ends just now or the system does not tell, may be at work.
	all.asleep = all.asleep && own && !gone;
	for (const fs::directory_iterator end; !gone && at != end; at.increment(gone)) {
		char state = '?';
		stat_of(at->path()) >> state;
		std::ifstream children(at->path() / "children");
		all.asleep = all.asleep && state == 'S' && children;
		for (pid_t child = 0; children >> child;)
			add(child, all);
	}
}

} // namespace

bool Pulse::hangs(double now) {
	Doings all;
	add(root, all);
	const double passed = looked < 0 ? 0 : std::min(longest_look, now - looked);
	looked = now;
	if (all.asleep)
		slept += passed;
	if (slept == 0 || all.spent - spent_then > around * limit) {
		slept = 0;
		spent_then = all.spent;
	}
	return slept >= limit;
}

} // namespace farm
