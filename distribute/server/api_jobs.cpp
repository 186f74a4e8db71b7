// SPDX-License-Identifier: AGPL-3.0-or-later
// What submitters and watchers ask.
#include "distribute/common/error.h"
#include "distribute/protocol/fields.h"
#include "distribute/server/api.h"

namespace farm {

void add_job_routes(Router& router, Farm& farm) {
	router.add(
		"POST", "/v1/jobs",
		[&farm](Request& r) -> Awaitable<Response> {
			JobSpec spec = parse_object(r.body).get<JobSpec>();
			const auto bundle = farm.files().bundle(spec.bundle);
			if (!bundle)
				throw HttpError(409, "the server does not have bundle " + spec.bundle);
			for (const auto& file : bundle->files) {
				if (!farm.files().has_file(file.sha256))
					throw HttpError(409, "the server does not have the bundle's file " + file.name);
				// The bundle's limits are checked by what its list says.
				if (const auto size = fs::file_size(farm.files().file(file.sha256));
					size != static_cast<std::uintmax_t>(file.bytes))
					throw HttpError(409, "the bundle's file " + file.name + " has " + std::to_string(size) +
											 " bytes, and its list says " + std::to_string(file.bytes));
			}
			const JobId id = co_await farm.submit(std::move(spec));
			co_return answer({{"job", id}}, 201);
		},
		limits::message_bytes);

	router.add("GET", "/v1/jobs", [&farm](Request&) -> Awaitable<Response> {
		json list = json::array();
		for (const auto& [id, job] : farm.jobs())
			list.push_back(describe(farm, job));
		co_return answer({{"jobs", list}});
	});
	router.add("GET", "/v1/jobs/*", [&farm](Request& r) -> Awaitable<Response> {
		const Job& job = farm.job(id_of(r.parts[0], "job"));
		json whole = describe(farm, job);
		whole["spec"] = job.row.spec;
		co_return answer(whole);
	});
	router.add("GET", "/v1/jobs/*/pictures", [&farm](Request& r) -> Awaitable<Response> {
		const Job& job = farm.job(id_of(r.parts[0], "job"));
		json names = json::array();
		for (size_t i = 0; i < job.stitched.size(); ++i)
			if (job.stitched[i])
				names.push_back(job.row.spec.picture(job.row.spec.frame(static_cast<int>(i))));
		co_return answer({{"pictures", names}});
	});
	router.add("GET", "/v1/jobs/*/log", [&farm](Request& r) -> Awaitable<Response> {
		const JobId id = id_of(r.parts[0], "job");
		const JobSpec spec = farm.job(id).row.spec;
		auto read = [&farm, id] { return farm.book().failures(id); };
		const auto failures = co_await in_pool(farm.io(), farm.threads(), read);
		json list = json::array();
		for (const FailureRow& f : failures)
			list.push_back({{"strip", f.strip}, {"frame", spec.frame_of(f.strip)}, {"row", spec.row_of(f.strip)},
				{"worker", f.worker}, {"when", f.when}, {"line", f.line}, {"log", f.log}});
		co_return answer({{"failures", list}});
	});
	router.add("GET", "/v1/jobs/*/frames/*", [&farm](Request& r) -> Awaitable<Response> {
		const Job& job = farm.job(id_of(r.parts[0], "job"));
		const JobSpec& spec = job.row.spec;
		for (int i = 0; i < spec.frames(); ++i)
			if (spec.picture(spec.frame(i)) == r.parts[1] && job.stitched[static_cast<size_t>(i)]) {
				Response picture;
				picture.type = spec.format == Format::png ? "image/png" : "image/x-exr";
				picture.file = farm.files().frame(job.row.id, r.parts[1]);
				co_return picture;
			}
		throw HttpError(404, "job " + r.parts[0] + " has no finished frame " + r.parts[1]);
	});
	router.add("GET", "/v1/jobs/*/film", [&farm](Request& r) -> Awaitable<Response> {
		const Job& job = farm.job(id_of(r.parts[0], "job"));
		Response film;
		film.type = "video/mp4";
		film.file = farm.files().frame(job.row.id, job.row.spec.name + ".mp4");
		if (job.row.stage != Stage::done || !fs::exists(film.file))
			throw HttpError(404, "job " + r.parts[0] + " has no film" + (job.row.error.empty() ? "" : ": " + job.row.error));
		co_return film;
	});
	router.add(
		"POST", "/v1/jobs/*/pause",
		[&farm](Request& r) -> Awaitable<Response> {
			co_await farm.pause(id_of(r.parts[0], "job"), true);
			co_return answer(json::object());
		},
		limits::message_bytes);
	router.add(
		"POST", "/v1/jobs/*/resume",
		[&farm](Request& r) -> Awaitable<Response> {
			co_await farm.pause(id_of(r.parts[0], "job"), false);
			co_return answer(json::object());
		},
		limits::message_bytes);
	router.add(
		"POST", "/v1/jobs/*/cancel",
		[&farm](Request& r) -> Awaitable<Response> {
			co_await farm.cancel(id_of(r.parts[0], "job"));
			co_return answer(json::object());
		},
		limits::message_bytes);
	router.add(
		"POST", "/v1/jobs/*/retry",
		[&farm](Request& r) -> Awaitable<Response> {
			co_await farm.retry(id_of(r.parts[0], "job"));
			co_return answer(json::object());
		},
		limits::message_bytes);
	router.add("DELETE", "/v1/jobs/*", [&farm](Request& r) -> Awaitable<Response> {
		co_await farm.remove(id_of(r.parts[0], "job"));
		co_return answer(json::object());
	});
}

} // namespace farm
