// SPDX-License-Identifier: AGPL-3.0-or-later
// Strips to frames, frames to a film.
#include "distribute/common/error.h"
#include "distribute/server/farm.h"
#include "distribute/stitch/film.h"
#include "distribute/stitch/picture.h"

#include <cstdio>

namespace farm {
namespace {

std::string digits(PixelHash hash) {
	char text[17];
	std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
	return text;
}

} // namespace

bool Farm::frame_complete(const Job& job, int index) const {
	const int per = job.row.spec.strips_per_frame();
	for (int s = index * per; s < (index + 1) * per; ++s)
		if (scheduler.state(job.row.id, s) != StripState::settled)
			return false;
	return true;
}

fs::path Farm::settled_file(const Job& job, int strip) const {
	const PixelHash hash = scheduler.jobs().at(job.row.id).result[static_cast<size_t>(strip)].hash;
	return spool.strip(job.row.id, strip, digits(hash), job.row.spec.suffix());
}

std::optional<fs::path> Farm::settled_strip(JobId id, int strip) const {
	if (!scheduler.jobs().count(id) || scheduler.state(id, strip) != StripState::settled)
		return std::nullopt;
	return settled_file(job(id), strip);
}

std::vector<fs::path> Farm::strip_files(const Job& job, int index) const {
	const int per = job.row.spec.strips_per_frame();
	std::vector<fs::path> files;
	for (int s = index * per; s < (index + 1) * per; ++s)
		files.push_back(settled_file(job, s));
	return files;
}

void Farm::strip_settled(JobId id, int strip) {
	const auto found = all_jobs.find(id);
	if (found == all_jobs.end())
		return;
	const std::string pixels = digits(scheduler.jobs().at(id).result[static_cast<size_t>(strip)].hash);
	note([=](Database& db) { rows::set_settled(db, id, strip, pixels); });
	events.strip(id, strip);
	const int index = strip / found->second.row.spec.strips_per_frame();
	if (!found->second.stitched[static_cast<size_t>(index)] && frame_complete(found->second, index)) {
		to_stitch.emplace_back(id, index);
		stitch_bell->ring();
	}
}

Awaitable<void> Farm::assemble() {
	std::map<JobId, std::string> said; // once, not at each try
	while (true) {
		if (to_stitch.empty()) {
			stitch_bell = std::make_shared<Bell>(context);
			co_await stitch_bell->wait();
			continue;
		}
		const auto [id, index] = to_stitch.front();
		bool again = false;
		try {
			if (index >= 0)
				co_await stitch_frame(id, index);
			else
				co_await finish(id);
		} catch (const std::exception& e) {
			again = all_jobs.count(id) > 0;
			std::string& told = said[id];
			if (again && told != e.what())
				say("job " + std::to_string(id) + ": " + e.what() + "; trying again until it works");
			told = e.what();
			if (again)
				all_jobs.at(id).doing = waits_because(told);
			events.job(id);
		}
		to_stitch.pop_front();
		if (!again)
			said.erase(id);
		if (again) { // a full disk has to be emptied by somebody
			to_stitch.emplace_back(id, index);
			auto pause = std::make_shared<Bell>(context);
			co_await pause->wait(3);
		}
	}
}

Awaitable<void> Farm::stitch_frame(JobId id, int index) {
	const auto found = all_jobs.find(id);
	const auto ready = [&] { return all_jobs.count(id) && scheduler.jobs().count(id) && frame_complete(all_jobs.at(id), index); };
	if (found == all_jobs.end() || !ready() || found->second.stitched[static_cast<size_t>(index)])
		co_return;
	const JobSpec spec = found->second.row.spec;
	const auto strips = strip_files(found->second, index);
	const fs::path part = spool.fresh(), whole = spool.frame(id, spec.picture(spec.frame(index)));
	auto work = [=] {
		try {
			stitch(spec, strips, part);
			move_durably(part, whole);
		} catch (...) { // what is half done takes room
			std::error_code ignored;
			fs::remove(part, ignored);
			throw;
		}
	};
	co_await in_pool(context, pool, std::move(work));
	// One of its strips may have been called into question meanwhile.
	const auto same = [&] { return ready() && strip_files(all_jobs.at(id), index) == strips; };
	if (!same())
		co_return;
	Ledger::Work note_it = [=](Database& db) { rows::set_frame(db, id, index, true); };
	co_await commit(std::move(note_it));
	if (!same()) {
		std::error_code ignored;
		fs::remove(whole, ignored);
		co_return;
	}
	Job& job = all_jobs.at(id);
	job.stitched[static_cast<size_t>(index)] = true;
	job.doing.clear();
	++job.frames_done;
	events.strip(id, index * spec.strips_per_frame());
	if (job.frames_done == spec.frames())
		to_stitch.emplace_back(id, -1);
}

Awaitable<void> Farm::finish(JobId id) {
	const auto found = all_jobs.find(id);
	if (found == all_jobs.end() || found->second.frames_done < found->second.row.spec.frames() ||
		found->second.row.stage == Stage::done)
		co_return;
	const JobSpec spec = found->second.row.spec;
	std::string remark;
	if (spec.film_rate > 0) {
		found->second.doing = "encoding the film";
		events.job(id);
		std::vector<fs::path> pictures;
		for (int i = 0; i < spec.frames(); ++i)
			pictures.push_back(spool.frame(id, spec.picture(spec.frame(i))));
		const fs::path film = spool.frame(id, spec.name + ".mp4");
		// The frames are what was promised; without ffmpeg the job is done all the same, and says so.
		auto work = [=, this] { make_film(pictures, spec.film_rate, film, spool.incoming()); };
		try {
			co_await in_pool(context, pool, std::move(work));
		} catch (const Error& e) {
			if (e.disk_full())
				throw;
			remark = e.what();
		}
	}
	if (!all_jobs.count(id) || all_jobs.at(id).frames_done < spec.frames())
		co_return;
	const double ended = wall_time();
	// What a full disk kept from being noted is made up for.
	std::vector<std::string> settled;
	if (notes_lost)
		for (const Settled& s : scheduler.jobs().at(id).result)
			settled.push_back(digits(s.hash));
	Ledger::Work work = [=](Database& db) {
		for (size_t s = 0; s < settled.size(); ++s)
			rows::set_settled(db, id, static_cast<int>(s), settled[s]);
		for (int i = 0; i < spec.frames() && !settled.empty(); ++i)
			rows::set_frame(db, id, i, true);
		rows::set_stage(db, id, Stage::done, remark, ended);
		rows::end_leases(db, id);
	};
	co_await commit(std::move(work));
	if (!all_jobs.count(id))
		co_return;
	all_jobs.at(id).doing.clear();
	set_stage(all_jobs.at(id), Stage::done, remark);
	Changes changes;
	scheduler.forget_job(id, changes);
	apply(changes);
	auto clear = [this, id] { spool.remove_strips(id); };
	co_await in_pool(context, pool, clear);
}

} // namespace farm
