// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm-worker: renders strips for a server.
#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/render/povray.h"
#include "distribute/worker/worker.h"

#include <cstdio>
#include <pthread.h>
#include <signal.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace farm;

const std::vector<Option> own_options = {
	{"--server", "URL", "also from BHFARM_SERVER; default http://127.0.0.1:7700", ""},
	{"--token-file", "FILE", "the token in it opens; also from BHFARM_TOKEN_FILE", ""},
	{"--ca", "FILE", "the certificate authority to trust, PEM; also from BHFARM_CA", ""},
	{"--slots", "N", "strips at a time; default one a core", ""},
	{"--name", "NAME", "for people; default the host's name", ""},
	{"--idle-exit", "SECONDS", "leave after so long without work; 0: stay", "0"},
	{"--grace", "SECONDS", "what strips may still take after SIGTERM before they are given back", "20"},
	{"--nice", "N", "niceness of povray", "19"},
	{"--when-idle", "", "take nothing while others use more than half of the cores", ""},
	{"--cache", "DIR", "where scenes are kept; default $XDG_CACHE_HOME/bhfarm", ""},
	{"--povray", "FILE", "the povray to run; default the one beside this program", ""},
};

std::vector<Option> all_options() {
	std::vector<Option> all = own_options;
	all.insert(all.end(), limit_options.begin(), limit_options.end());
	all.push_back({"--help", "", "this", ""});
	return all;
}

std::string host_name() {
	char name[256] = "";
	::gethostname(name, sizeof name - 1);
	return *name ? name : "worker";
}

int work(const Arguments& arguments) {
	WorkerSettings settings;
	settings.server = access_from(arguments.get("--server"), arguments.get("--token-file"), arguments.get("--ca"));
	settings.name = arguments.get("--name").empty() ? host_name() : arguments.get("--name");
	const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
	settings.slots = arguments.has("--slots") ? static_cast<int>(arguments.number("--slots", 1, 1024)) : cores;
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

	// Signals come to one thread, which tells the others.
	sigset_t signals;
	sigemptyset(&signals);
	for (const int s : {SIGINT, SIGTERM, SIGHUP})
		sigaddset(&signals, s);
	pthread_sigmask(SIG_BLOCK, &signals, nullptr);
	::signal(SIGPIPE, SIG_IGN);
	Worker worker(settings);
	std::thread([&worker, signals] {
		for (int s = 0, count = 0; sigwait(&signals, &s) == 0;)
			worker.stop(s == SIGTERM && ++count == 1);
	}).detach();
	worker.run();
	return 0;
}

} // namespace

int main(int argc, char** argv) {
	name_program("bhfarm-worker", true);
	try {
		const std::vector<Option> options = all_options();
		const Arguments arguments({argv + 1, argv + argc}, options);
		if (arguments.has("--help")) {
			std::printf("bhfarm-worker [options]\nRenders strips for a bhfarm-server. SIGTERM: finishes them, SIGINT: gives them "
						"back, then leaves.\n%s",
				help_lines(options).c_str());
			return 0;
		}
		if (!arguments.rest.empty())
			throw Error("what is '" + arguments.rest[0] + "'? --help lists the options");
		const int code = work(arguments);
		std::_Exit(code); // the signals' thread still looks at what would be torn down
	} catch (const std::exception& e) {
		name_program("bhfarm-worker", false);
		say(e.what());
		return 1;
	}
}
