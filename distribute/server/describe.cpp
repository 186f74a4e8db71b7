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

namespace {

/// Out or waiting for other than the first time: it failed, its worker fell silent, or it wants a second opinion.
bool once_more(const JobState& job, int strip) {
	if (const auto found = job.trouble.find(strip); found != job.trouble.end())
		return found->second.failures > 0 || found->second.losses > 0 || !found->second.votes.empty();
	const auto out = job.out.find(strip);
	return out != job.out.end() && out->second.size() > 1;
}

} // namespace

char strip_letter(const Farm& farm, const Job& job, int strip) {
	const auto found = farm.schedule().jobs().find(job.row.id);
	if (found == farm.schedule().jobs().end()) // over: what is left is whole frames
		return job.stitched[static_cast<size_t>(strip / job.row.spec.strips_per_frame())] ? 's' : 'w';
	switch (found->second.state[static_cast<size_t>(strip)]) {
	case StripState::waiting:
		return once_more(found->second, strip) ? 'r' : 'w';
	case StripState::out:
		return once_more(found->second, strip) ? 'a' : 'o';
	case StripState::settled:
		return 's';
	case StripState::given_up:
		return 'x';
	}
	return '?';
}

std::string strip_letters(const Farm& farm, const Job& job) {
	std::string letters(static_cast<size_t>(job.row.spec.strips()), 'w');
	for (size_t i = 0; i < letters.size(); ++i)
		letters[i] = strip_letter(farm, job, static_cast<int>(i));
	return letters;
}

json describe_all(const Farm& farm) {
	json jobs = json::array(), workers = json::array();
	for (const auto& [id, job] : farm.jobs())
		jobs.push_back(describe(farm, job));
	for (const auto& [id, guest] : farm.guests())
		workers.push_back(describe(farm, guest));
	return {{"event", "all"}, {"time", wall_time()}, {"jobs", jobs}, {"workers", workers}};
}

json describe(const Farm& farm, const Touched& touched) {
	json jobs = json::array(), workers = json::array(), strips = json::object(), removed = json::array(), gone = json::array();
	for (const auto& [id, numbers] : touched.strips) {
		const auto job = farm.jobs().find(id);
		if (job == farm.jobs().end()) {
			removed.push_back(id);
			continue;
		}
		jobs.push_back(describe(farm, job->second));
		if (numbers.empty())
			continue;
		json& list = strips[std::to_string(id)] = json::array();
		for (const int strip : numbers)
			list.push_back({strip, std::string(1, strip_letter(farm, job->second, strip))});
	}
	for (const WorkerId& id : touched.workers) {
		const auto guest = farm.guests().find(id);
		if (guest == farm.guests().end())
			gone.push_back(id);
		else
			workers.push_back(describe(farm, guest->second));
	}
	return {{"event", "changes"}, {"time", wall_time()}, {"jobs", jobs}, {"strips", strips}, {"workers", workers},
		{"removed", removed}, {"gone", gone}, {"failures", touched.failures}};
}

json describe(const Farm& farm, const Job& job) {
	const JobSpec& spec = job.row.spec;
	json j{{"id", job.row.id}, {"name", spec.name}, {"stage", stage_name(job.row.stage)}, {"error", job.row.error},
		{"doing", farm.doing(job)}, {"created", job.row.created}, {"ended", job.row.ended}, {"priority", spec.priority},
		{"width", spec.width}, {"height", spec.height}, {"animation", spec.animation}, {"digits", spec.digits},
		{"format", spec.format == Format::png ? "png" : "exr"}, {"first", spec.first}, {"last", spec.last}, {"step", spec.step},
		{"frames", spec.frames()}, {"frames_done", job.frames_done}, {"strips", spec.strips()},
		{"strips_per_frame", spec.strips_per_frame()}, {"strip_rows", spec.strip_rows}, {"whole_because", spec.whole_because},
		{"film", spec.film_rate > 0 ? spec.name + ".mp4" : ""}};
	const auto state = farm.schedule().jobs().find(job.row.id);
	const bool live = state != farm.schedule().jobs().end();
	j["strips_done"] = live ? state->second.settled : job.frames_done * spec.strips_per_frame();
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
	j["rests"] = std::max(0.0, w.rests_until - farm.now());
	j["silent"] = farm.now() - w.heard;
	json strips = json::array();
	for (const LeaseId id : w.leases)
		if (const Lease* lease = farm.schedule().lease(id))
			strips.push_back({{"job", lease->job}, {"strip", lease->strip}, {"seconds", farm.now() - lease->started}});
	j["strips"] = strips;
	return j;
}

} // namespace farm
