// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm-worker: renders strips for a server.
#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/render/povray.h"
#include "distribute/worker/worker.h"

#include <cstdlib>
#include <pthread.h>
#include <signal.h>
#include <thread>

namespace {

using namespace farm;

const std::vector<Option> own_options = {
	{"--slots", "N", "strips at a time; default one a core", ""},
	{"--name", "NAME", "for people; default the host's name", ""},
	{"--idle-exit", "SECONDS", "leave after so long without work; 0: stay", "0"},
	{"--grace", "SECONDS", "what strips may still take after SIGTERM before they are given back", "20"},
	{"--nice", "N", "niceness of povray", "19"},
	{"--when-idle", "", "take nothing while others use more than half of the cores", ""},
	{"--cache", "DIR", "where scenes are kept; default $XDG_CACHE_HOME/bhfarm", ""},
	povray_option,
};

void work(const Arguments& arguments) {
	// Signals come to one thread, which tells the others. Until it is there they wait: what is tried out leaves nothing behind.
	sigset_t signals;
	sigemptyset(&signals);
	for (const int s : {SIGINT, SIGTERM, SIGHUP})
		sigaddset(&signals, s);
	pthread_sigmask(SIG_BLOCK, &signals, nullptr);
	::signal(SIGPIPE, SIG_IGN);
	WorkerSettings settings;
	settings.server = access_from(arguments);
	settings.name = arguments.get("--name").empty() ? host_name() : arguments.get("--name");
	if (settings.name.empty())
		settings.name = "worker";
	settings.slots = slots_from(arguments);
	settings.idle_exit = static_cast<double>(arguments.number("--idle-exit", 0, 1000000));
	settings.grace = static_cast<double>(arguments.number("--grace", 0, 1000000));
	settings.renderer.nice = static_cast<int>(arguments.number("--nice", 0, 19));
	settings.when_idle = arguments.has("--when-idle");
	settings.cache = arguments.get("--cache").empty() ? cache_folder() : fs::path(arguments.get("--cache"));
	settings.scratch = fs::temp_directory_path();
	settings.renderer.light = std::make_shared<LightStore>(settings.scratch);
	settings.renderer.povray = find_povray(arguments.get("--povray"));
	settings.renderer.limits = limits_from(arguments, settings.slots);
	if (!arguments.has("--no-sandbox"))
		settings.renderer.sandbox = Sandbox(settings.renderer.povray);

	Worker worker(settings);
	std::thread([&worker, signals] {
		for (int s = 0, count = 0; sigwait(&signals, &s) == 0;)
			worker.stop(s == SIGTERM && ++count == 1);
	}).detach();
	worker.run();
}

} // namespace

int main(int argc, char** argv) {
	return run_program("bhfarm-worker", true, [&]() -> int {
		const auto options = access_options + own_options + limit_options;
		const Arguments arguments({argv + 1, argv + argc}, options);
		help_if_asked(arguments,
			"bhfarm-worker [options]\n"
			"Renders strips for a bhfarm-server. SIGTERM: finishes them, SIGINT: gives them back, then leaves.",
			options);
		no_other_words(arguments);
		work(arguments); // and its scratch folder is gone
		std::_Exit(0);   // the signals' thread still looks at what would be torn down
	});
}
