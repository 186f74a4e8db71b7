// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/server/api.h"

#include <charconv>

namespace farm {

Response answer(const json& body, int status) {
	Response r;
	r.status = status;
	r.body = body.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
	return r;
}

std::int64_t id_of(const std::string& part, const char* what) {
	std::int64_t id = 0;
	const auto [at, error] = std::from_chars(part.data(), part.data() + part.size(), id);
	if (error != std::errc() || at != part.data() + part.size() || id < 1)
		throw HttpError(404, std::string("there is no ") + what + " '" + part + "'");
	return id;
}

json describe(const Farm& farm, const Job& job) {
	const JobSpec& spec = job.row.spec;
	json j{{"id", job.row.id}, {"name", spec.name}, {"stage", stage_name(job.row.stage)}, {"error", job.row.error},
		{"doing", job.doing}, {"created", job.row.created}, {"ended", job.row.ended}, {"priority", spec.priority},
		{"width", spec.width}, {"height", spec.height}, {"animation", spec.animation}, {"first", spec.first}, {"last", spec.last},
		{"step", spec.step}, {"frames", spec.frames()}, {"frames_done", job.frames_done}, {"strips", spec.strips()},
		{"strips_per_frame", spec.strips_per_frame()}, {"strip_rows", spec.strip_rows}, {"whole_because", spec.whole_because},
		{"film", spec.film_rate > 0 ? spec.name + ".mp4" : ""}};
	const auto state = farm.schedule().jobs().find(job.row.id);
	const bool live = state != farm.schedule().jobs().end();
	j["strips_done"] = live ? state->second.settled : job.row.stage == Stage::done ? spec.strips() : 0;
	j["strips_out"] = live ? static_cast<int>(state->second.out.size()) : 0;
	j["strip_seconds"] = live && state->second.timed ? json(state->second.seconds / state->second.timed) : json(nullptr);
	const double eta = job.row.stage == Stage::running ? farm.eta(job.row.id) : -1;
	j["eta"] = eta >= 0 ? json(eta) : json(nullptr);
	return j;
}

json describe(const Farm& farm, const Guest& guest) {
	json j{{"id", guest.hello.id}, {"name", guest.hello.name}, {"slots", guest.hello.slots}, {"povray", guest.hello.povray},
		{"from", guest.from}, {"since", guest.since}};
	const auto state = farm.schedule().workers().find(guest.hello.id);
	if (state == farm.schedule().workers().end())
		return j;
	const WorkerState& w = state->second;
	j["busy"] = w.leases.size();
	j["done"] = w.done;
	j["aside"] = w.aside;
	j["draining"] = w.draining;
	j["silent"] = farm.now() - w.heard;
	json strips = json::array();
	for (const LeaseId id : w.leases)
		if (const Lease* lease = farm.schedule().lease(id))
			strips.push_back({{"job", lease->job}, {"strip", lease->strip}, {"seconds", farm.now() - lease->started}});
	j["strips"] = strips;
	return j;
}

} // namespace farm
