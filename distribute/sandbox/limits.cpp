// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/sandbox/limits.h"

#include <algorithm>
#include <csignal>
#include <cmath>
#include <sys/resource.h>
#include <unistd.h>

namespace farm {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t mega = 1 << 20, block = 4096;

/// Of the machine, in bytes.
std::int64_t memory_here() { return std::int64_t(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGESIZE); }

std::string after(const char* option, double value, const char* unit) {
	return std::string(" than ") + option + " allows, " + std::to_string(std::llround(value)) + " " + unit;
}

} // namespace

const std::vector<Option> limit_options = {
	{"--wall-limit", "SECONDS", "the most a strip may take; 0: no limit, here and below", "86400"},
	{"--hang-limit", "SECONDS", "how long it may do nothing at all", "300"},
	{"--cpu-limit", "SECONDS", "likewise of processor time; default as --wall-limit", ""},
	{"--memory-limit", "MB", "likewise of address space; default a slot's share of the machine's memory, at least 2048", ""},
	{"--output-limit", "MB", "what it may write, all files together", "4096"},
	{"--no-sandbox", "", "no fence around scenes: only for those whose submitters you trust", ""},
};

Limits limits_from(const Arguments& a, int slots) {
	Limits limits;
	limits.wall = static_cast<double>(a.number("--wall-limit", 0, 1000000000));
	limits.cpu = a.get("--cpu-limit").empty() ? limits.wall : static_cast<double>(a.number("--cpu-limit", 0, 1000000000));
	limits.still = static_cast<double>(a.number("--hang-limit", 0, 1000000000));
	limits.output = mega * a.number("--output-limit", 0, 1 << 30);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
	const std::int64_t share = 0; // such programs map terabytes
#else
	const std::int64_t share = std::max(2048 * mega, memory_here() / slots);
#endif
	limits.memory = a.get("--memory-limit").empty() ? share : mega * a.number("--memory-limit", 0, 1 << 30);
	return limits;
}

std::map<int, std::uint64_t> kernel_limits(const Limits& limits) {
	std::map<int, std::uint64_t> kept = {{RLIMIT_CORE, 0}};
	if (limits.cpu > 0)
		kept[RLIMIT_CPU] = static_cast<std::uint64_t>(std::ceil(limits.cpu));
	if (limits.memory > 0)
		kept[RLIMIT_AS] = static_cast<std::uint64_t>(limits.memory);
	if (limits.output > 0)
		kept[RLIMIT_FSIZE] = static_cast<std::uint64_t>(limits.output);
	return kept;
}

Overseer::Overseer(const Limits& l, const fs::path& f) : limits(l), folder(f) {}

bool Overseer::too_much_written() const {
	std::int64_t sum = 0;
	std::error_code gone; // a file may go while we look
	for (fs::recursive_directory_iterator at(folder, gone), end; !gone && at != end && sum <= limits.output; at.increment(gone)) {
		const auto size = at->symlink_status(gone).type() == fs::file_type::regular ? at->file_size(gone) : 0;
		sum += gone ? block : std::max(block, static_cast<std::int64_t>(size));
		gone.clear();
	}
	return sum > limits.output;
}

std::string Overseer::complaint() {
	const auto now = Clock::now();
	if (limits.wall > 0 && now - start > std::chrono::duration<double>(limits.wall))
		return "the render took longer" + after("--wall-limit", limits.wall, "s");
	if (pulse && limits.still > 0 && now >= next_beat) {
		next_beat = now + std::chrono::seconds(1);
		if (pulse->hangs(std::chrono::duration<double>(now - start).count()))
			return "the render did nothing for longer" + after("--hang-limit", limits.still, "s");
	}
	if (limits.output > 0 && now >= next_look) {
		if (too_much_written())
			return "the render wrote more" + after("--output-limit", double(limits.output) / mega, "MB");
		// Many files take long to look at: a tenth of the time at most goes there.
		next_look = Clock::now() + std::max<Clock::duration>(std::chrono::milliseconds(500), 10 * (Clock::now() - now));
	}
	return "";
}

std::string Overseer::complaint(int code, const std::string& log) {
	if (code == 0)
		return "";
	if (limits.cpu > 0 && code == 128 + SIGXCPU)
		return "the render took more processor time" + after("--cpu-limit", limits.cpu, "s");
	next_look = {};
	if (limits.output > 0 && (code == 128 + SIGXFSZ || too_much_written()))
		return "the render wrote more" + after("--output-limit", double(limits.output) / mega, "MB");
	for (const char* words : {"bad_alloc", "ut of memory", "annot allocate"})
		if (limits.memory > 0 && log.find(words) != std::string::npos)
			return "the render needed more memory" + after("--memory-limit", double(limits.memory) / mega, "MB");
	return "";
}

} // namespace farm
