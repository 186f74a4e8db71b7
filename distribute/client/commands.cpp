// SPDX-License-Identifier: AGPL-3.0-or-later
// The commands that talk to a server elsewhere.
#include "distribute/client/commands.h"

#include "distribute/client/show.h"
#include "distribute/client/submit.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"
#include "distribute/common/process.h"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>
#include <unistd.h>

namespace farm {

namespace {

const Option json_option{"--json", "", "for machines", ""};
const std::atomic<bool> never = false;

/// The words of a command that asks a server, after its help if that is wanted.
Arguments asked(const Words& words, const std::string& usage, const std::vector<Option>& own = {}) {
	const auto options = own + std::vector<Option>{json_option} + access_options;
	Arguments a(words, options);
	help_if_asked(a, usage, options);
	return a;
}

Client connect(const Arguments& a) { return Client(access_from(a)); }

std::int64_t job_number(const Arguments& a) {
	if (a.rest.size() != 1)
		throw Error("which job? 'bhfarm status' lists them");
	return whole_number(a.rest[0], "the job's number", 1, INT64_MAX);
}

std::string path_of(std::int64_t job, const std::string& more = "") { return "/v1/jobs/" + std::to_string(job) + more; }

std::string moment(double seconds) {
	const auto t = static_cast<std::time_t>(seconds);
	std::tm local{};
	char text[32];
	std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", localtime_r(&t, &local));
	return text;
}

/// Again when the network fails; what came before is not lost by it.
template <class Function> auto patiently(Function function) {
	for (int tries = 1;; ++tries) {
		try {
			return function();
		} catch (const Unreachable&) {
			if (tries == 5)
				throw;
			std::this_thread::sleep_for(std::chrono::seconds(1));
		}
	}
}

int outcome(const json& job) {
	const std::string stage = job.value("stage", ""), error = job.value("error", "");
	say("job " + std::to_string(job.value("id", 0)) + " " + stage + (stage == "done" ? "" : ", " + progress_text(job)) +
		(error.empty() ? "" : ": " + error));
	return stage == "done" ? 0 : 1;
}

} // namespace

int submit_command(const Words& words) {
	const Arguments a = asked(
		words, "bhfarm submit SCENE.ini|SCENE.pov [options] [POV-Ray's own words]\nPrints the job's number.", scene_options);
	Client client = connect(a);
	const json workers = client.get("/v1/workers");
	int slots = 0;
	for (const json& w : workers.at("workers"))
		slots += w.value("slots", 0);
	// With nobody there yet, a small lab's worth.
	Prepared prepared = prepare(a);
	try_out(prepared, a, slots > 0 ? slots : 16);
	// So that a job whose answer was lost is not two jobs.
	prepared.scene.spec.client_key = random_hex(16);
	const std::int64_t id = patiently([&] { return send_job(client, prepared); });
	if (a.has("--json"))
		std::puts(client.get(path_of(id)).dump().c_str());
	else
		std::printf("%lld\n", static_cast<long long>(id));
	return 0;
}

int status_command(const Words& words) {
	const Arguments a = asked(words, "bhfarm status [JOB]");
	Client client = connect(a);
	const json answer = a.rest.empty() ? client.get("/v1/jobs") : json{{"jobs", {client.get(path_of(job_number(a)))}}};
	if (a.has("--json")) {
		std::puts((a.rest.empty() ? answer["jobs"] : answer["jobs"][0]).dump().c_str());
		return 0;
	}
	std::vector<std::vector<std::string>> rows = {{"JOB", "NAME", "STAGE", "FRAMES", "STRIPS", "TO GO", "CREATED", ""}};
	for (const json& j : answer["jobs"]) {
		const auto part = [&](const char* done, const char* all) {
			return std::to_string(j.value(done, 0)) + "/" + std::to_string(j.value(all, 0));
		};
		rows.push_back(
			{std::to_string(j.value("id", 0)), j.value("name", ""), j.value("stage", ""), part("frames_done", "frames"),
				part("strips_done", "strips"), j["eta"].is_number() ? clock_text(j["eta"].get<double>()) : "-",
				moment(j.value("created", 0.0)), j.value("error", "").empty() ? j.value("doing", "") : j.value("error", "")});
	}
	print_table(rows);
	return 0;
}

int watch_command(const Words& words) {
	const Arguments a =
		asked(words, "bhfarm watch JOB\nUntil it is done; exit code 0 if it is, 1 if it failed or was cancelled.");
	Client client = connect(a);
	const json job = follow(client, job_number(a), 600, never);
	if (a.has("--json"))
		std::puts(job.dump().c_str());
	return outcome(job);
}

int workers_command(const Words& words) {
	const Arguments a = asked(words, "bhfarm workers");
	if (!a.rest.empty())
		throw Error("what is '" + a.rest[0] + "'? 'bhfarm workers' lists all");
	const json answer = connect(a).get("/v1/workers");
	if (a.has("--json")) {
		std::puts(answer["workers"].dump().c_str());
		return 0;
	}
	std::vector<std::vector<std::string>> rows = {{"WORKER", "NAME", "FROM", "BUSY", "STRIPS", "HEARD", ""}};
	for (const json& w : answer["workers"])
		rows.push_back({w.value("id", ""), w.value("name", ""), w.value("from", ""),
			std::to_string(w.value("busy", 0)) + "/" + std::to_string(w.value("slots", 0)), std::to_string(w.value("done", 0)),
			clock_text(w.value("silent", 0.0)),
			!w.value("aside", "").empty() ? "set aside: " + w.value("aside", "")
			: w.value("draining", false)  ? "draining"
			: w.value("rests", 0.0) > 0   ? "rests after failures, for " + clock_text(w.value("rests", 0.0))
										  : ""});
	print_table(rows);
	return 0;
}

int log_command(const Words& words) {
	const Arguments a = asked(words, "bhfarm log JOB\nWhat failed, where, and what POV-Ray said.");
	const json answer = connect(a).get(path_of(job_number(a), "/log"));
	if (a.has("--json")) {
		std::puts(answer["failures"].dump().c_str());
		return 0;
	}
	for (const json& f : answer["failures"])
		std::printf("%s frame %d, from row %d, on %s: %s\n%s\n", moment(f.value("when", 0.0)).c_str(), f.value("frame", 0),
			f.value("row", 0) + 1, for_terminal(f.value("worker", "")).c_str(), for_terminal(f.value("line", "")).c_str(),
			for_terminal(f.value("log", ""), true).c_str());
	return 0;
}

int fetch_command(const Words& words) {
	const Arguments a = asked(words,
		"bhfarm fetch JOB\nThe frames that are finished, and the film. Those that are there already are not fetched again.",
		{{"--to", "DIR", "where to put them", "."}});
	Client client = connect(a);
	const std::int64_t id = job_number(a);
	const json job = client.get(path_of(id)), done = client.get(path_of(id, "/pictures"));
	const fs::path folder = a.get("--to");
	make_folder(folder);
	json names = json::array();
	const auto bring = [&](const std::string& name, const std::string& path) {
		if (name.find('/') != std::string::npos)
			throw Error("the server names a file '" + name + "'");
		if (!fs::exists(folder / name))
			patiently([&] { client.download(path, folder / name); });
		if (!a.has("--json"))
			std::puts((folder / name).c_str());
		names.push_back((folder / name).string());
	};
	if (done.at("pictures").empty())
		say("no frame of job " + std::to_string(id) + " is finished yet");
	for (const json& picture : done.at("pictures"))
		bring(picture.get<std::string>(), path_of(id, "/frames/" + url_encode(picture.get<std::string>())));
	if (const std::string film = job.value("film", ""); job.value("stage", "") == "done" && !film.empty())
		bring(film, path_of(id, "/film"));
	if (a.has("--json"))
		std::puts(json{{"files", names}}.dump().c_str());
	return 0;
}

int change_command(const std::string& what, const Words& words) {
	const Arguments a = asked(words, "bhfarm " + what + " JOB");
	Client client = connect(a);
	client.post(path_of(job_number(a), "/" + what), json::object());
	if (a.has("--json"))
		std::puts(client.get(path_of(job_number(a))).dump().c_str());
	return 0;
}

int remove_command(const Words& words) {
	const Arguments a = asked(words, "bhfarm remove JOB\nThe job, its frames, and all the server knows of it.");
	connect(a).remove(path_of(job_number(a)));
	if (a.has("--json"))
		std::puts(json{{"removed", job_number(a)}}.dump().c_str());
	return 0;
}

int drain_command(const Words& words) {
	const Arguments a =
		asked(words, "bhfarm drain WORKER\nThe worker finishes what it has and leaves. 'bhfarm workers' lists them.");
	if (a.rest.size() != 1)
		throw Error("which worker? 'bhfarm workers' lists them");
	Client client = connect(a);
	const json workers = client.get("/v1/workers");
	std::string id;
	for (const json& w : workers.at("workers"))
		if (w.value("id", "") == a.rest[0] || w.value("name", "") == a.rest[0])
			id = w.value("id", "");
	if (id.empty())
		throw Error("there is no worker " + a.rest[0]);
	client.post("/v1/workers/" + id + "/drain", json::object());
	if (a.has("--json"))
		std::puts(json{{"draining", id}}.dump().c_str());
	return 0;
}

int token_command(const Words& words) {
	const Arguments a(words, {});
	help_if_asked(a, "bhfarm token new\nPrints a new token, for the server's --token-file and the workers'.", {});
	if (a.rest != Words{"new"})
		throw Error("'bhfarm token new' prints a new token; put it into the server's --token-file and the workers'");
	std::puts(random_hex(32).c_str());
	return 0;
}

int source_command(const Words& words) {
	const Arguments a(words, access_options);
	help_if_asked(a,
		"bhfarm source >FILE.tar.gz\nThe source of what runs here; with --server or BHFARM_SERVER, of what runs there.",
		access_options);
	if (!a.rest.empty())
		throw Error("what is '" + a.rest[0] + "'? The source goes to stdout");
	if (::isatty(1))
		throw Error("the source is a .tar.gz: send it to a file, bhfarm source >povray-blackhole.tar.gz");
	if (a.get("--server").empty() && !std::getenv("BHFARM_SERVER")) {
		Command beside;
		beside.words = {(program_folder() / "bhfarm-server").string(), "--source"};
		return run(beside);
	}
	const ScratchFolder scratch(fs::temp_directory_path());
	connect(a).download("/source", scratch.path() / "source");
	write_out(read_file(scratch.path() / "source"), "the source");
	return 0;
}

} // namespace farm
