// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm render: a server and a worker of one's own, for one job.
#include "distribute/client/claim.h"
#include "distribute/client/commands.h"
#include "distribute/client/local_farm.h"
#include "distribute/client/show.h"
#include "distribute/client/submit.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"

#include <csignal>
#include <cstdio>
#include <set>
#include <unistd.h>

namespace farm {
namespace {

std::atomic<bool> interrupted = false;

void interrupt(int) { interrupted = true; }

const char* const stopped = "stopped; the same command goes on where it was";

/// Where the state of a command is kept from one time to the next: by the words about the scene and where the pictures go.
fs::path state_of(const Prepared& p, const fs::path& output) {
	json all = {p.scene.spec, p.scene.scene.string(), output.string()};
	for (const fs::path& library : p.scene.libraries)
		all.push_back(library.string());
	return state_folder() / "render" / sha256(all.dump()).substr(0, 24);
}

/// What goes on of a job in there: everything hangs on the scene's files too. Not on how frames are cut, which hangs on how busy
/// the machine was.
std::string key_of(const Prepared& p) {
	JobSpec spec = p.scene.spec;
	spec.strip_rows = 1;
	return sha256(json(spec).dump()).substr(0, 24);
}

/// Removes what films left behind that nobody went on with for thirty days.
void remove_forgotten() {
	std::error_code error;
	for (fs::directory_iterator at(state_folder() / "render", error), end; !error && at != end; at.increment(error)) {
		std::error_code ignored;
		const auto age = fs::file_time_type::clock::now() - fs::last_write_time(at->path() / "token", ignored);
		if (ignored || age < std::chrono::hours(30 * 24))
			continue;
		try {
			const FileLock lock(at->path() / "lock", "");
			fs::remove_all(at->path(), ignored);
		} catch (const Error&) { // it is at work, for more than thirty days
		}
	}
}

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
		if (job.value("frames_done", 0) <= static_cast<int>(there.size()))
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

/// What this state's server still has of the scene as it was before it was edited.
void remove_others(Client& client, std::int64_t id) {
	const json all = client.get("/v1/jobs");
	for (const json& job : all.at("jobs"))
		if (const auto other = job.value("id", std::int64_t(0)); other != id)
			client.remove("/v1/jobs/" + std::to_string(other));
}

} // namespace

int render_command(const Words& words) {
	const auto options = scene_options + std::vector<Option>{{"--slots", "N", "strips at a time; default one a core", ""}};
	const Arguments a(words, options);
	help_if_asked(a,
		"bhfarm render SCENE.ini|SCENE.pov [options] [POV-Ray's own words]\n"
		"Renders on this machine. After Ctrl-C the same command goes on where it was.",
		options);
	const int slots = slots_from(a);
	for (const int s : {SIGINT, SIGTERM, SIGHUP})
		std::signal(s, interrupt);
	Prepared prepared = prepare(a);
	JobSpec& spec = prepared.scene.spec;
	const fs::path output =
		fs::absolute(prepared.scene.output.empty() ? fs::path(".") : prepared.scene.output).lexically_normal();
	const fs::path film = prepared.film.empty() ? fs::path() : fs::absolute(prepared.film);
	for (const fs::path& folder : {output, film.empty() ? output : film.parent_path()})
		if (!fs::is_directory(folder))
			throw Error("there is no folder " + folder.string() + " for the pictures");
		else if (::access(folder.c_str(), W_OK) != 0)
			throw system_error("cannot write to the folder " + folder.string());

	remove_forgotten();
	const fs::path state = state_of(prepared, output);
	make_folder(state_folder());
	// Two of these may not write the same pictures, nor the same film.
	std::vector<std::unique_ptr<Claim>> claims;
	std::set<fs::path> written = {output / (spec.name + spec.suffix())};
	if (!film.empty())
		written.insert(film);
	for (const fs::path& file : written)
		claims.push_back(std::make_unique<Claim>(state_folder() / "claims", file));
	const bool fresh = !fs::exists(state);
	make_folder(state);
	fs::permissions(state, fs::perms::owner_all); // the token is nobody else's
	const FileLock lock(state / "lock", "this very job is being rendered already");
	write_durably(state / "token", random_hex(32) + "\n");
	fs::permissions(state / "token", fs::perms::owner_read | fs::perms::owner_write);

	LocalFarm farm({state, slots, a.get("--povray"), prepared.sandbox.fences()});
	std::string url;
	try {
		url = farm.start_server(interrupted);
		if (!interrupted)
			farm.start_worker();
		try_out(prepared, a, slots, &interrupted); // while the worker tries povray
		if (interrupted)
			throw Stopped();
	} catch (const std::exception& e) {
		farm.stop(true);
		std::error_code ignored;
		if (fresh)
			fs::remove_all(state, ignored);
		say(!interrupted ? e.what() : fresh ? "stopped before anything was rendered" : stopped);
		return interrupted ? 130 : 1;
	}
	spec.client_key = key_of(prepared);
	Output frames(spec, output);
	Client client(access_from(url, (state / "token").string(), ""));
	const std::int64_t id = send_job(client, prepared);
	remove_others(client, id);
	json job = client.get("/v1/jobs/" + std::to_string(id));
	if (job.value("stage", "") == "failed") {
		client.post("/v1/jobs/" + std::to_string(id) + "/retry", json::object());
	} else if (const int done = job.value("strips_done", 0); done > 0) {
		say("going on where it was: " + progress_text(job));
	}
	job = follow(client, id, 60, interrupted, [&](const json& now) {
		farm.mend(interrupted);
		frames.bring(client, farm.spool(), now);
	});
	const std::string stage = job.value("stage", "");
	farm.stop(stage == "done");
	if (stage != "done") {
		const std::string error = job.value("error", "");
		say(stage == "failed" ? error : stopped);
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
