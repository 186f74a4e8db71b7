// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm: what people type.
#include "distribute/client/commands.h"

#include "distribute/common/error.h"

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace {

const char* const usage = R"(bhfarm COMMAND ...          'bhfarm COMMAND --help' has each one's options
  render  SCENE [options]   renders a scene or an animation on this machine, all set up
  submit  SCENE [options]   gives it to a server; prints the job's number
  status  [JOB]             how jobs stand
  watch   JOB               the same, until it is done
  fetch   JOB               frames and film
  log     JOB               what failed, and what POV-Ray said
  cancel, pause, resume, retry, remove  JOB
  workers                   who renders
  drain   WORKER            it finishes what it has and leaves
  slurm   --workers N       starts workers as a job of Slurm's
  token   new               prints a token for server and workers
  source                    what runs here, as the AGPL asks
)";

int dispatch(const std::string& command, const farm::Words& words) {
	using namespace farm;
	const std::pair<const char*, int (*)(const Words&)> commands[] = {{"render", render_command}, {"submit", submit_command},
		{"status", status_command}, {"watch", watch_command}, {"fetch", fetch_command}, {"log", log_command},
		{"workers", workers_command}, {"drain", drain_command}, {"remove", remove_command}, {"slurm", slurm_command},
		{"token", token_command}, {"source", source_command}};
	for (const auto& [name, function] : commands)
		if (command == name)
			return function(words);
	for (const char* name : {"cancel", "pause", "resume", "retry"})
		if (command == name)
			return change_command(command, words);
	throw Error("there is no command '" + command + "'; bhfarm --help lists them");
}

} // namespace

int main(int argc, char** argv) {
	std::signal(SIGPIPE, SIG_IGN);
	const farm::Words words(argv + 1, argv + argc);
	if (words.empty() || words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
		std::fputs(usage, words.empty() ? stderr : stdout);
		return words.empty() ? 2 : 0;
	}
	return farm::run_program("bhfarm", false, [&] { return dispatch(words[0], {words.begin() + 1, words.end()}); });
}
