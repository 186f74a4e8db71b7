// SPDX-License-Identifier: AGPL-3.0-or-later
// What the scheduler's decisions bring about: in the ledger, on the page, for the job.
#include "distribute/common/error.h"
#include "distribute/server/farm.h"

namespace farm {

std::string Farm::place(const JobSpec& spec, int strip) const {
	const int row = spec.row_of(strip);
	const std::string rows = spec.strips_per_frame() == 1
								 ? ""
								 : "rows " + std::to_string(row + 1) + " to " + std::to_string(row + spec.rows_of(strip));
	const std::string frame = spec.animation ? "frame " + std::to_string(spec.frame_of(strip)) : "";
	return frame.empty() && rows.empty() ? "the picture" : frame + (frame.empty() || rows.empty() ? "" : ", ") + rows;
}

const std::string& Farm::name_of(const WorkerId& worker) const {
	const auto guest = all_guests.find(worker);
	return guest == all_guests.end() ? worker : guest->second.hello.name;
}

void Farm::apply(const Changes& changes) {
	for (const Lease& lease : changes.ended) {
		note([id = lease.id](Database& db) { rows::end_lease(db, id); });
		events.strip(lease.job, lease.strip, lease.worker);
	}
	for (const StripRef& s : changes.reopened) {
		note([s](Database& db) { rows::set_settled(db, s.job, s.strip, ""); });
		Job& job = all_jobs.at(s.job);
		const int index = s.strip / job.row.spec.strips_per_frame();
		// The picture goes at once: should the row outlive it, it counts for nothing.
		std::error_code ignored;
		fs::remove(spool.frame(s.job, job.row.spec.picture(job.row.spec.frame(index))), ignored);
		if (job.stitched[static_cast<size_t>(index)]) {
			job.stitched[static_cast<size_t>(index)] = false;
			--job.frames_done;
			note([=](Database& db) { rows::set_frame(db, s.job, index, false); });
		}
		events.strip(s.job, s.strip);
	}
	for (const StripRef& s : changes.settled)
		strip_settled(s.job, s.strip);
	for (const auto& [worker, why] : changes.aside) {
		say("worker " + name_of(worker) + " is set aside: " + why);
		note([=, id = worker, because = why, at = wall_time()](Database& db) { rows::set_aside(db, id, because, at); });
		events.worker(worker);
	}
	for (const WorkerId& worker : changes.gone) {
		const auto guest = all_guests.find(worker);
		if (guest == all_guests.end())
			continue;
		say("worker " + guest->second.hello.name + " is not heard of any more");
		if (!scheduler.workers().count(worker))
			all_guests.erase(guest);
		events.worker(worker);
	}
	for (const StripRef& s : changes.given_up) {
		Job& job = all_jobs.at(s.job);
		const auto split = changes.split.find(s.job);
		if (split != changes.split.end()) {
			std::string names;
			for (const WorkerId& worker : split->second)
				names += (names.empty() ? "" : " and ") + name_of(worker);
			set_stage(job, Stage::failed,
				place(job.row.spec, s.strip) + " came out differently on " + names +
					": with one more worker, 'retry' finds out which is right");
		} else {
			std::string line = "workers that had it fell silent";
			int tries = 0;
			for (const FailureRow& f : ledger.failures(s.job))
				if (f.strip == s.strip) {
					line = f.line;
					++tries;
				}
			const bool missing = line.find("annot open") != std::string::npos || line.find("annot find") != std::string::npos;
			if (missing && line.find("--assets") == std::string::npos)
				line += " (--assets sends files that only some frames read)";
			set_stage(job, Stage::failed,
				place(job.row.spec, s.strip) + " failed on " + std::to_string(tries > 0 ? tries : settings.rules.losses) +
					" tries: " + line);
		}
		say("job " + std::to_string(s.job) + " failed: " + job.row.error);
	}
	if (!changes.ended.empty() || !changes.reopened.empty())
		wake(static_cast<int>(changes.ended.size() + changes.reopened.size()));
}

} // namespace farm
