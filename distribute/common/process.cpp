// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/process.h"

#include "distribute/common/error.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

extern char** environ;

namespace farm {

Process::Process(const Command& command) {
	// All that allocates happens before fork: other threads may hold the heap's lock.
	std::vector<char*> words;
	for (const auto& word : command.words)
		words.push_back(const_cast<char*>(word.c_str()));
	words.push_back(nullptr);
	std::vector<std::string> variables;
	for (char** e = environ; *e; ++e) {
		const std::string entry = *e;
		if (!command.environment.count(entry.substr(0, entry.find('='))))
			variables.push_back(entry);
	}
	for (const auto& [name, value] : command.environment)
		variables.push_back(name + "=" + value);
	std::vector<char*> environment;
	for (auto& v : variables)
		environment.push_back(v.data());
	environment.push_back(nullptr);

	const pid_t parent = ::getpid();
	pid = ::fork();
	if (pid < 0)
		throw system_error("cannot start " + command.words.at(0));
	if (pid == 0) {
		::setpgid(0, 0);
		::prctl(PR_SET_PDEATHSIG, SIGTERM);
		if (::getppid() != parent)
			::_exit(127);
		sigset_t none;
		sigemptyset(&none);
		::sigprocmask(SIG_SETMASK, &none, nullptr);
		for (const int s : {SIGINT, SIGTERM, SIGPIPE, SIGHUP})
			::signal(s, SIG_DFL);
		if (command.nice && ::nice(command.nice) == -1) {
		} // as nice as allowed
		const int in = ::open("/dev/null", O_RDONLY);
		if (in >= 0)
			::dup2(in, 0);
		if (!command.log.empty()) {
			const int out = ::open(command.log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
			if (out < 0)
				::_exit(127);
			::dup2(out, 1);
			::dup2(out, 2);
		}
		unsigned first_unused = 3;
		for (const auto& [descriptor, file] : command.opened) {
			const int d = ::open(file.c_str(), O_RDONLY);
			if (d < 0 || ::dup2(d, descriptor) < 0)
				::_exit(127);
			first_unused = static_cast<unsigned>(descriptor) + 1;
		}
		// What other threads have open is none of its business.
		::close_range(first_unused, ~0U, CLOSE_RANGE_CLOEXEC);
		for (const auto& [what, most] : command.limits) {
			rlimit limit{};
			if (::getrlimit(static_cast<__rlimit_resource>(what), &limit) == 0) {
				limit.rlim_cur = std::min<rlim_t>(most, limit.rlim_max);
				// At the hard limit the kernel's signal is SIGKILL, which does not say why.
				limit.rlim_max = std::min<rlim_t>(most + (what == RLIMIT_CPU ? 5 : 0), limit.rlim_max);
				::setrlimit(static_cast<__rlimit_resource>(what), &limit);
			}
		}
		if (!command.folder.empty() && ::chdir(command.folder.c_str()) != 0)
			::_exit(127);
		::execvpe(words[0], words.data(), environment.data());
		::_exit(127);
	}
	::setpgid(pid, pid);
	watch = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
}

Process::Process(Process&& other) noexcept
	: pid(std::exchange(other.pid, -1)), watch(std::exchange(other.watch, -1)), status(other.status) {}

Process::~Process() {
	if (pid > 0 && status < 0) {
		signal(SIGKILL);
		over(-1);
	}
	if (watch >= 0)
		::close(watch);
}

bool Process::over(double seconds) {
	if (status >= 0)
		return true;
	pollfd p{watch, POLLIN, 0};
	if (watch >= 0 && ::poll(&p, 1, seconds < 0 ? -1 : static_cast<int>(seconds * 1000)) == 0)
		return false;
	int s = 0;
	const pid_t got = ::waitpid(pid, &s, watch >= 0 && seconds >= 0 ? WNOHANG : 0);
	if (got == 0 || (got < 0 && errno == EINTR))
		return false;
	status = got < 0 ? 127 : WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
	return true;
}

void Process::signal(int number) const {
	if (pid > 0 && status < 0 && ::kill(-pid, number) != 0)
		::kill(pid, number);
}

std::string host_name() {
	char name[256] = "";
	::gethostname(name, sizeof name - 1);
	return name;
}

int run(const Command& command, const std::atomic<bool>* stop) {
	Process process(command);
	while (!process.over(stop ? 0.05 : -1))
		if (stop && *stop)
			throw Stopped();
	return process.code();
}

} // namespace farm
