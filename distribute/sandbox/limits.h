// SPDX-License-Identifier: AGPL-3.0-or-later
/// How much one render may take, and what it is told when it takes more.
#ifndef FARM_LIMITS_H
#define FARM_LIMITS_H

#include "distribute/common/arguments.h"
#include "distribute/sandbox/pulse.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace farm {

/// 0 stands for no limit.
struct Limits {
	double wall = 0;         ///< seconds
	double cpu = 0;          ///< seconds, of all threads
	double still = 0;        ///< seconds without doing anything
	std::int64_t memory = 0; ///< bytes of address space
	std::int64_t output = 0; ///< bytes written, all files together; a file counts for one block at least
};

/// A worker's options for them, and what they say; `slots` renders share the machine's memory.
extern const std::vector<Option> limit_options;
Limits limits_from(const Arguments& arguments, int slots);

/// Those that the kernel keeps, as a Command has them.
std::map<int, std::uint64_t> kernel_limits(const Limits& limits);

/// Looks at a render under way: how long it takes and what it has written.
class Overseer {
public:
	/// `folder` is where all that it writes goes.
	Overseer(const Limits& limits, const std::filesystem::path& folder);
	/// The render's process, to see whether it hangs.
	void watch(pid_t process) { pulse.emplace(process, limits.still); }
	/// One line if a limit is passed, else empty. Looks at the disk and the process now and then only; call it as often as you
	/// like.
	std::string complaint();
	/// One line if a render that ended with this code, having printed this, was stopped by a limit of the kernel's; else empty.
	std::string complaint(int code, const std::string& log);

private:
	using Clock = std::chrono::steady_clock;
	bool too_much_written() const;
	Limits limits;
	std::filesystem::path folder;
	Clock::time_point start = Clock::now(), next_look = Clock::now(), next_beat = Clock::now();
	std::optional<Pulse> pulse;
};

} // namespace farm
#endif
