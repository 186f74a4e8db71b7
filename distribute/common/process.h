// SPDX-License-Identifier: AGPL-3.0-or-later
/// Other programs, run and waited for.
#ifndef FARM_PROCESS_H
#define FARM_PROCESS_H

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace farm {

/// What to run. The child is in a process group of its own and gets SIGTERM when the thread that started it dies.
struct Command {
	std::vector<std::string> words;                 ///< the program and its arguments; no shell
	std::filesystem::path folder;                   ///< where it runs; empty: here
	std::map<std::string, std::string> environment; ///< added to this program's own
	std::filesystem::path log;                      ///< its stdout and stderr; empty: this program's own
	int nice = 0;
	std::map<int, std::uint64_t> limits = {};         ///< RLIMIT_... and the value, in the kernel's unit
	std::map<int, std::filesystem::path> opened = {}; ///< descriptors, from 3 on, and the files it reads from them
};

/// A running program; killed, with its group, if this ends first.
class Process {
public:
	explicit Process(const Command& command);
	~Process();
	Process(Process&& other) noexcept;
	Process(const Process&) = delete;

	/// Whether it is over, within so many seconds (0: at once, negative: as long as it takes).
	bool over(double seconds);
	/// Signals the whole group.
	void signal(int number) const;
	/// Its exit code once it is over; 128 + the signal's number if one ended it, as shells have it; 127 if it could not be run.
	int code() const { return status; }
	pid_t id() const { return pid; }

private:
	pid_t pid = -1;
	int watch = -1; // pidfd
	int status = -1;
};

/// This machine's, or nothing.
std::string host_name();

/// Runs to the end and returns the exit code. Once `stop` is true, it is killed and Stopped thrown.
int run(const Command& command, const std::atomic<bool>* stop = nullptr);

} // namespace farm
#endif
