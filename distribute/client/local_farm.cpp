// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/client/local_farm.h"

#include "distribute/common/error.h"

#include <csignal>

namespace farm {
namespace {

/// Waits for the end of a process that was told to; killed if it will not, and then leaves its scratch files behind.
void end(std::optional<Process>& process) {
	constexpr double patience = 60; // it takes a tenth of a second, and a busy machine its time
	if (process && !process->over(patience))
		process->signal(SIGKILL);
	process.reset();
}

void tell(std::optional<Process>& process, int signal) {
	if (process)
		process->signal(signal);
}

std::string last_line(const fs::path& log) {
	std::string text = fs::exists(log) ? read_file(log) : "";
	while (!text.empty() && text.back() == '\n')
		text.pop_back();
	const std::string line = text.substr(text.rfind('\n') + 1);
	const size_t name = line.find(": ");
	return line.empty() ? "it did not start" : name == std::string::npos ? line : line.substr(name + 2);
}

} // namespace

std::string LocalFarm::start_server(const std::atomic<bool>& interrupted) {
	fs::remove(spool() / "url");
	Command command;
	command.words = {(program_folder() / "bhfarm-server").string(), "--listen", address, "--spool", spool().string(), "--lease",
		"5", "--check-every", "0", "--token-file", (set.state / "token").string()};
	command.log = set.state / "server.log";
	server.reset();
	server.emplace(command);
	while (!interrupted && !fs::exists(spool() / "url"))
		if (server->over(0.01))
			throw Error(last_line(command.log));
	if (interrupted)
		return "";
	const std::string text = read_file(spool() / "url");
	url = text.substr(0, text.find('\n'));
	address = url.substr(url.find("//") + 2);
	return url;
}

void LocalFarm::start_worker() {
	Command command;
	command.words = {(program_folder() / "bhfarm-worker").string(), "--server", url, "--token-file",
		(set.state / "token").string(), "--slots", std::to_string(set.slots), "--name", "here", "--nice", "0", "--cache",
		(set.state / "cache").string()};
	if (!set.povray.empty())
		command.words.insert(command.words.end(), {"--povray", set.povray});
	// One's own scene may have all of one's own machine.
	command.words.insert(command.words.end(), {"--memory-limit", "0"});
	if (!set.fenced)
		command.words.push_back("--no-sandbox");
	command.log = set.state / "worker.log";
	worker.reset();
	worker.emplace(command);
}

void LocalFarm::mend(const std::atomic<bool>& interrupted) {
	const bool no_server = server->over(0), no_worker = worker->over(0);
	if ((no_server || no_worker) && ++deaths > 20)
		throw Error(std::string(no_server ? "the server" : "the worker") +
					" dies again and again: " + last_line(set.state / (no_server ? "server.log" : "worker.log")));
	if (no_server)
		start_server(interrupted);
	if (no_worker)
		start_worker();
}

void LocalFarm::stop(bool all_done) {
	tell(worker, SIGINT);
	if (!all_done)
		end(worker);
	tell(server, SIGTERM);
	end(worker);
	end(server);
}

} // namespace farm
