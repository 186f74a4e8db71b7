// SPDX-License-Identifier: AGPL-3.0-or-later
// Start, jobs, and what the scheduler's changes bring about. guests.cpp has the workers' side, assembly.cpp the frames'.
#include "distribute/server/farm.h"

#include "distribute/common/error.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include <chrono>
#include <cstdio>

namespace farm {

double wall_time() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

Time Farm::now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

const char* stage_name(Stage stage) {
	switch (stage) {
	case Stage::running:
		return "running";
	case Stage::paused:
		return "paused";
	case Stage::done:
		return "done";
	case Stage::failed:
		return "failed";
	case Stage::cancelled:
		return "cancelled";
	}
	return "?";
}

Farm::Farm(boost::asio::io_context& c, const FarmSettings& s)
	: context(c), settings(s), spool(s.spool), ledger(spool.ledger()), scheduler(s.rules, ledger.next_lease()), events(c),
	  pool(static_cast<size_t>(s.threads)), stitch_bell(std::make_shared<Bell>(c)) {
	restore();
	const auto guarded = [](std::exception_ptr e) {
		if (e)
			std::rethrow_exception(e);
	};
	boost::asio::co_spawn(context, tick(), guarded);
	boost::asio::co_spawn(context, assemble(), guarded);
	boost::asio::co_spawn(context, keep_house(), guarded);
}

Farm::~Farm() {
	pool.stop();
	pool.join();
}

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

void Farm::restore() {
	Changes nothing_new;
	for (const JobRow& row : ledger.jobs()) {
		enter(row);
		if (!scheduler.jobs().count(row.id))
			continue;
		for (const ReportRow& report : ledger.reports(row.id)) {
			const PixelHash hash = std::stoull(report.pixels.substr(0, 16), nullptr, 16);
			if (fs::exists(spool.strip(row.id, report.strip, report.pixels, row.spec.suffix())))
				scheduler.restore_vote(row.id, report.strip, report.worker, hash, report.settled, nothing_new);
		}
		if (row.stage == Stage::failed)
			scheduler.restore_failed(row.id);
		scheduler.set_paused(row.id, row.stage == Stage::paused);
	}
	for (const Lease& lease : ledger.leases())
		scheduler.restore_lease(lease, now());
	for (const auto& [id, frame] : ledger.frames()) {
		const auto job = all_jobs.find(id);
		if (job == all_jobs.end() || job->second.row.stage == Stage::done)
			continue;
		const auto index = static_cast<size_t>(frame);
		if (index < job->second.stitched.size() &&
			fs::exists(spool.frame(id, job->second.row.spec.picture(job->second.row.spec.frame(frame))))) {
			job->second.stitched[index] = true;
			++job->second.frames_done;
		}
	}
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

namespace {

/// Waits until what `start` begins has told its end; throws HttpError 507 if that was a bad one.
template <class Start> Awaitable<void> written(boost::asio::io_context& context, const Start& start) {
	auto error = std::make_shared<std::string>();
	auto bell = std::make_shared<Bell>(context);
	start([error, bell](const std::string& what) {
		*error = what;
		bell->ring();
	});
	co_await bell->wait();
	if (!error->empty()) {
		say(*error);
		throw HttpError(507, *error);
	}
}

} // namespace

Awaitable<void> Farm::commit(Ledger::Work work) {
	const auto start = [this, &work](Ledger::Done done) { ledger.post(std::move(work), std::move(done)); };
	co_await written(context, start);
}

Awaitable<void> Farm::move(fs::path from, fs::path to) {
	const auto start = [this, &from, &to](Mover::Done done) { mover.move(from, to, std::move(done)); };
	co_await written(context, start);
}

void Farm::note(Ledger::Work work) {
	ledger.post(std::move(work), [](const std::string& error) {
		if (!error.empty())
			say(error);
	});
}

const Job& Farm::job(JobId id) const {
	const auto found = all_jobs.find(id);
	if (found == all_jobs.end())
		throw HttpError(404, "there is no job " + std::to_string(id));
	return found->second;
}

Awaitable<JobId> Farm::submit(JobSpec spec) {
	const double created = wall_time();
	JobId id = 0;
	Ledger::Work work = [&](Database& db) { id = rows::add_job(db, spec, created); };
	co_await commit(std::move(work));
	if (!all_jobs.count(id)) {
		JobRow row;
		row.id = id;
		row.spec = std::move(spec);
		row.created = created;
		enter(row);
		events.job(id);
		wake(row.spec.strips());
	}
	co_return id;
}

void Farm::set_stage(Job& job, Stage stage, const std::string& error) {
	job.row.stage = stage;
	job.row.error = error;
	job.row.ended = stage == Stage::running || stage == Stage::paused ? 0 : wall_time();
	const JobId id = job.row.id;
	const double ended = job.row.ended;
	note([=](Database& db) { rows::set_stage(db, id, stage, error, ended); });
	events.job(id);
}

Awaitable<void> Farm::pause(JobId id, bool paused) {
	const Stage from = job(id).row.stage, to = paused ? Stage::paused : Stage::running;
	if (from != Stage::running && from != Stage::paused)
		throw HttpError(409, "job " + std::to_string(id) + " is " + stage_name(from));
	Ledger::Work work = [=](Database& db) { rows::set_stage(db, id, to, "", 0); };
	co_await commit(std::move(work));
	scheduler.set_paused(id, paused);
	set_stage(all_jobs.at(id), to);
	wake(scheduler.waiting());
}

Awaitable<void> Farm::cancel(JobId id) {
	if (job(id).row.stage == Stage::done)
		throw HttpError(409, "job " + std::to_string(id) + " is done");
	Ledger::Work work = [=](Database& db) { rows::set_stage(db, id, Stage::cancelled, "", wall_time()); };
	co_await commit(std::move(work));
	Changes changes;
	scheduler.forget_job(id, changes);
	apply(changes);
	set_stage(all_jobs.at(id), Stage::cancelled);
}

Awaitable<void> Farm::retry(JobId id) {
	const Stage from = job(id).row.stage;
	if (from != Stage::failed)
		throw HttpError(
			409, "job " + std::to_string(id) + " is " + stage_name(from) + "; only one that failed can be tried again");
	Ledger::Work work = [=](Database& db) {
		rows::set_stage(db, id, Stage::running, "", 0);
		rows::clear_failures(db, id);
	};
	co_await commit(std::move(work));
	scheduler.retry(id);
	set_stage(all_jobs.at(id), Stage::running);
	wake(scheduler.waiting());
}

Awaitable<void> Farm::remove(JobId id) {
	job(id);
	Ledger::Work work = [=](Database& db) { rows::remove_job(db, id); };
	co_await commit(std::move(work));
	Changes changes;
	scheduler.forget_job(id, changes);
	apply(changes);
	all_jobs.erase(id);
	auto clear = [this, id] { spool.remove_job(id); };
	co_await in_pool(context, pool, clear);
	events.job(id);
}

std::string Farm::place(const JobSpec& spec, int strip) const {
	const int per = spec.strips_per_frame(), row = strip % per * spec.strip_rows;
	const std::string rows =
		per == 1 ? "" : "rows " + std::to_string(row + 1) + " to " + std::to_string(std::min(row + spec.strip_rows, spec.height));
	const std::string frame = spec.animation ? "frame " + std::to_string(spec.frame(strip / per)) : "";
	return frame.empty() && rows.empty() ? "the picture" : frame + (frame.empty() || rows.empty() ? "" : ", ") + rows;
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
		const auto guest = all_guests.find(worker);
		say("worker " + (guest == all_guests.end() ? worker : guest->second.hello.name) + " is set aside: " + why);
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
		std::string line = "no worker could";
		for (const FailureRow& f : ledger.failures(s.job))
			line = f.strip == s.strip ? f.line : line;
		set_stage(job, Stage::failed,
			place(job.row.spec, s.strip) + " failed on " + std::to_string(settings.rules.tries) + " tries: " + line);
		say("job " + std::to_string(s.job) + " failed: " + job.row.error);
	}
	if (!changes.ended.empty() || !changes.reopened.empty())
		wake(static_cast<int>(changes.ended.size() + changes.reopened.size()));
}

void Farm::wake(int how_many) {
	for (; how_many > 0 && !sleepers.empty(); --how_many) {
		sleepers.front()->ring();
		sleepers.pop_front();
	}
}

Awaitable<void> Farm::tick() {
	boost::asio::steady_timer timer(context);
	while (true) {
		timer.expires_after(std::chrono::milliseconds(500));
		boost::system::error_code error;
		co_await timer.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, error));
		Changes changes;
		scheduler.tick(now(), changes);
		apply(changes);
		// Stragglers and rested workers: time alone makes work for somebody.
		if (!scheduler.leases().empty() || scheduler.waiting() > 0)
			wake(1 + scheduler.waiting());
	}
}

double Farm::eta(JobId id) const {
	const auto found = scheduler.jobs().find(id);
	if (found == scheduler.jobs().end() || found->second.timed == 0)
		return -1;
	const JobState& j = found->second;
	const auto busy = static_cast<double>(std::max<size_t>(j.out.size(), 1));
	return j.seconds / j.timed * (j.strips - j.settled) / busy;
}

} // namespace farm
