// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm render: a server and a worker of one's own, for one job.
#include "distribute/client/commands.h"
#include "distribute/client/show.h"
#include "distribute/client/submit.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"
#include "distribute/common/process.h"

#include <csignal>
#include <cstdio>
#include <optional>
#include <set>
#include <thread>
#include <unistd.h>

namespace farm {
namespace {

std::atomic<bool> interrupted = false;

void interrupt(int) { interrupted = true; }

/// What goes on of this job from one command to the next: everything hangs on the scene's files, its options and where the
/// pictures go. Not on how frames are cut, which hangs on how busy the machine was.
std::string key_of(const Prepared& p, const fs::path& folder) {
	JobSpec spec = p.scene.spec;
	spec.strip_rows = 1;
	return sha256(json(spec).dump() + "\n" + folder.string()).substr(0, 24);
}

/// Waits for the end of a process that was told to; killed if it will not.
void end(std::optional<Process>& process) {
	if (process && !process->over(10))
		process->signal(SIGKILL);
	process.reset();
}

void tell(std::optional<Process>& process, int signal) {
	if (process)
		process->signal(signal);
}

/// A server and a worker of one's own, started again should one of them die.
class LocalFarm {
public:
	LocalFarm(const fs::path& state_folder, int slot_count, const std::string& povray_file, bool with_fence)
		: state(state_folder), slots(slot_count), povray(povray_file), fenced(with_fence) {}

	fs::path spool() const { return state / "spool"; }
	/// Where it listens; empty if we were interrupted first. Throws Error with the server's own last line.
	std::string start_server() {
		fs::remove(spool() / "url");
		Command command;
		command.words = {(program_folder() / "bhfarm-server").string(), "--listen", address, "--spool", spool().string(),
			"--lease", "5", "--check-every", "0", "--token-file", (state / "token").string()};
		command.log = state / "server.log";
		server.reset();
		server.emplace(command);
		while (!interrupted && !fs::exists(spool() / "url"))
			if (server->over(0.02))
				throw Error(last_line(command.log));
		if (interrupted)
			return "";
		const std::string text = read_file(spool() / "url");
		url = text.substr(0, text.find('\n'));
		address = url.substr(url.find("//") + 2);
		return url;
	}
	void start_worker() {
		Command command;
		command.words = {(program_folder() / "bhfarm-worker").string(), "--server", url, "--token-file",
			(state / "token").string(), "--slots", std::to_string(slots), "--name", "here", "--nice", "0", "--cache",
			(state / "cache").string()};
		if (!povray.empty())
			command.words.insert(command.words.end(), {"--povray", povray});
		// One's own scene may have all of one's own machine.
		command.words.insert(command.words.end(), {"--memory-limit", "0"});
		if (!fenced)
			command.words.push_back("--no-sandbox");
		command.log = state / "worker.log";
		worker.reset();
		worker.emplace(command);
	}
	void mend() {
		const bool no_server = server->over(0), no_worker = worker->over(0);
		if ((no_server || no_worker) && ++deaths > 20)
			throw Error(std::string(no_server ? "the server" : "the worker") +
						" dies again and again: " + last_line(state / (no_server ? "server.log" : "worker.log")));
		if (no_server)
			start_server();
		if (no_worker)
			start_worker();
	}
	/// `all_done`: nothing is to be given back, so that the worker need not be waited for before the server goes.
	void stop(bool all_done) {
		tell(worker, SIGINT);
		if (!all_done)
			end(worker);
		tell(server, SIGTERM);
		end(worker);
		end(server);
	}

private:
	static std::string last_line(const fs::path& log) {
		std::string text = fs::exists(log) ? read_file(log) : "";
		while (!text.empty() && text.back() == '\n')
			text.pop_back();
		const std::string line = text.substr(text.rfind('\n') + 1);
		const size_t name = line.find(": ");
		return line.empty() ? "it did not start" : name == std::string::npos ? line : line.substr(name + 2);
	}

	fs::path state;
	int slots;
	std::string povray, url, address = "127.0.0.1:0";
	bool fenced;
	std::optional<Process> server, worker;
	int deaths = 0;
};

/// Puts a finished picture where it belongs, whole or not at all; the server keeps its own, which costs nothing on the same disk.
void hand_over(const fs::path& from, const fs::path& to) {
	const fs::path part = to.string() + ".part";
	std::error_code error, ignored;
	fs::remove(part, ignored);
	fs::create_hard_link(from, part, error);
	if (error) // another disk
		fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
	// Of a disk that got full, the copying says only that it failed.
	if (error && fs::space(to.parent_path(), ignored).available < fs::file_size(from, ignored))
		error = std::make_error_code(std::errc::no_space_on_device);
	if (!error)
		fs::rename(part, to, error);
	fs::remove(part, ignored); // it stays where both are the same file already
	if (error)
		throw Error("cannot write " + to.string() + ": " + error.message() + "; the same command goes on where it was");
}

/// Frames as they are finished.
class Output {
public:
	Output(const JobSpec& s, const fs::path& f) : spec(s), folder(f) {}

	void bring(Client& client, const fs::path& spool, const json& job) {
		if (!job.is_object() || job.value("frames_done", 0) <= static_cast<int>(there.size()))
			return;
		const std::string number = std::to_string(job.value("id", 0));
		try {
			const json done = client.get("/v1/jobs/" + number + "/pictures");
			for (const json& picture : done.at("pictures"))
				if (const std::string name = picture.get<std::string>(); !there.count(name)) {
					hand_over(spool / "jobs" / number / "frames" / name, folder / name);
					there.insert(name);
				}
		} catch (const Unreachable&) { // the next time
		}
	}
	void rest(const fs::path& made) {
		for (int i = 0; i < spec.frames(); ++i) {
			const std::string name = spec.picture(spec.frame(i));
			if (!there.count(name))
				hand_over(made / name, folder / name);
			std::puts((folder / name).c_str());
		}
	}

private:
	const JobSpec& spec;
	fs::path folder;
	std::set<std::string> there;
};

} // namespace

int render_command(const Words& words) {
	const auto options = scene_options + std::vector<Option>{{"--slots", "N", "strips at a time; default one a core", ""},
											 {"--help", "", "this", ""}};
	const Arguments a(words, options);
	help_if_asked(a,
		"bhfarm render SCENE.ini|SCENE.pov [options] [POV-Ray's own words]\n"
		"Renders on this machine. After Ctrl-C the same command goes on where it was.",
		options);
	const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
	const int slots = a.has("--slots") ? static_cast<int>(a.number("--slots", 1, 1024)) : cores;
	Prepared prepared = prepare(a, slots);
	JobSpec& spec = prepared.scene.spec;
	const fs::path output =
		fs::absolute(prepared.scene.output.empty() ? fs::path(".") : prepared.scene.output).lexically_normal();
	const fs::path film = prepared.film.empty() ? fs::path() : fs::absolute(prepared.film);
	for (const fs::path& folder : {output, film.empty() ? output : film.parent_path()})
		if (!fs::is_directory(folder))
			throw Error("there is no folder " + folder.string() + " for the pictures");
		else if (::access(folder.c_str(), W_OK) != 0)
			throw system_error("cannot write to the folder " + folder.string());

	spec.client_key = key_of(prepared, output);
	const fs::path state = state_folder() / "render" / spec.client_key;
	fs::create_directories(state);
	fs::permissions(state, fs::perms::owner_all); // the token is nobody else's
	const FileLock lock(state / "lock", "this very job is being rendered already");
	write_durably(state / "token", random_hex(32) + "\n");
	fs::permissions(state / "token", fs::perms::owner_read | fs::perms::owner_write);

	std::signal(SIGINT, interrupt);
	std::signal(SIGTERM, interrupt);
	std::signal(SIGHUP, interrupt);
	LocalFarm farm(state, slots, a.get("--povray"), prepared.sandbox.fences());
	Output frames(spec, output);
	json job;
	if (const std::string url = farm.start_server(); !url.empty()) {
		farm.start_worker();
		Client client(access_from(url, (state / "token").string(), ""));
		const std::int64_t id = send_job(client, prepared);
		job = client.get("/v1/jobs/" + std::to_string(id));
		if (job.value("stage", "") == "failed") {
			client.post("/v1/jobs/" + std::to_string(id) + "/retry", json::object());
		} else if (const int done = job.value("strips_done", 0); done > 0) {
			say("going on where it was: " + progress_text(job));
		}
		job = follow(client, id, 60, interrupted, [&](const json& now) {
			farm.mend();
			frames.bring(client, farm.spool(), now);
		});
	}
	const std::string stage = job.is_object() ? job.value("stage", "") : "";
	farm.stop(stage == "done");
	if (stage != "done") {
		const std::string error = job.is_object() ? job.value("error", "") : "";
		say(stage == "failed" ? error : "stopped; the same command goes on where it was");
		return stage == "failed" ? 1 : 130;
	}
	const fs::path made = farm.spool() / "jobs" / std::to_string(job.value("id", 0)) / "frames";
	frames.rest(made);
	int code = 0;
	if (!film.empty() && fs::exists(made / (spec.name + ".mp4"))) {
		hand_over(made / (spec.name + ".mp4"), film);
		std::puts(film.c_str());
	} else if (!film.empty()) {
		say(job.value("error", "there is no film"));
		code = 1;
	}
	std::error_code ignored;
	fs::remove_all(state, ignored);
	return code;
}

} // namespace farm
