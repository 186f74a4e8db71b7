// SPDX-License-Identifier: AGPL-3.0-or-later
// What a start finds in the spool.
#include "distribute/common/error.h"
#include "distribute/server/farm.h"

namespace farm {

void Farm::enter(const JobRow& row) {
	Job& job = all_jobs[row.id];
	job.row = row;
	job.stitched.assign(static_cast<size_t>(row.spec.frames()), false);
	if (row.stage == Stage::done) {
		job.stitched.assign(job.stitched.size(), true);
		job.frames_done = row.spec.frames();
	} else if (row.stage != Stage::cancelled) {
		scheduler.add_job(row.id, row.spec.strips(), row.spec.priority);
		spool.make_job(row.id);
	}
}

// A row without its file is worth nothing, and neither is a file without its row: nobody was told of it.
Farm::SettledAs Farm::restore_strips(const JobRow& row, Changes& changes) {
	SettledAs settled;
	std::map<int, std::vector<Vote>> votes;
	std::set<std::string> names;
	for (const ReportRow& report : ledger.reports(row.id)) {
		const fs::path file = spool.strip(row.id, report.strip, report.pixels, row.spec.suffix());
		const PixelHash hash = std::stoull(report.pixels.substr(0, 16), nullptr, 16);
		names.insert(file.filename());
		if (fs::exists(file))
			votes[report.strip].push_back({report.worker, hash, report.settled});
		if (report.settled)
			settled[report.strip] = hash;
	}
	scheduler.restore_votes(row.id, votes, changes);
	spool.keep_strips(row.id, names);
	return settled;
}

// A frame that was stitched before the votes were counted anew, and a strip went to others, is none.
bool Farm::stitched_as(const Job& job, int index, const SettledAs& settled) const {
	const JobState& j = scheduler.jobs().at(job.row.id);
	const int per = job.row.spec.strips_per_frame();
	for (int s = index * per; s < (index + 1) * per; ++s)
		if (const auto was = settled.find(s); was == settled.end() || was->second != j.result[static_cast<size_t>(s)].hash)
			return false;
	return true;
}

void Farm::restore() {
	Changes changes;
	std::map<JobId, SettledAs> settled;
	for (const auto& [worker, why] : ledger.aside())
		scheduler.restore_aside(worker, why);
	for (const JobRow& row : ledger.jobs()) {
		enter(row);
		if (!scheduler.jobs().count(row.id)) { // killed just before they went
			spool.remove_strips(row.id);
			continue;
		}
		settled[row.id] = restore_strips(row, changes);
		if (row.stage == Stage::failed)
			scheduler.restore_failed(row.id);
		scheduler.set_paused(row.id, row.stage == Stage::paused);
	}
	for (const Lease& lease : ledger.leases()) {
		scheduler.restore_lease(lease, now());
		if (!scheduler.lease(lease.id))
			note([id = lease.id](Database& db) { rows::end_lease(db, id); });
	}
	for (const auto& [id, frame] : ledger.frames()) {
		const auto job = all_jobs.find(id);
		if (job == all_jobs.end() || job->second.row.stage == Stage::done || job->second.row.stage == Stage::cancelled)
			continue;
		const auto index = static_cast<size_t>(frame);
		const fs::path picture = spool.frame(id, job->second.row.spec.picture(job->second.row.spec.frame(frame)));
		if (index >= job->second.stitched.size() || !frame_complete(job->second, frame) ||
			!stitched_as(job->second, frame, settled[id])) {
			std::error_code ignored;
			fs::remove(picture, ignored);
		} else if (fs::exists(picture)) {
			job->second.stitched[index] = true;
			++job->second.frames_done;
		}
	}
	apply(changes);
	for (const auto& [id, job] : all_jobs) {
		if (!scheduler.jobs().count(id))
			continue;
		for (int i = 0; i < job.row.spec.frames(); ++i)
			if (!job.stitched[static_cast<size_t>(i)] && frame_complete(job, i))
				to_stitch.emplace_back(id, i);
		if (job.frames_done == job.row.spec.frames())
			to_stitch.emplace_back(id, -1);
	}
}

} // namespace farm
