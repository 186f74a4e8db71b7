// SPDX-License-Identifier: AGPL-3.0-or-later
// Start and jobs. guests.cpp has the workers' side, assembly.cpp the frames', changes.cpp what the scheduler's decisions bring
// about.
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

namespace {

/// Waits until what `start` begins has told its end, and tells the farm; throws HttpError 507 if that was a bad one.
template <class Start> Awaitable<void> written(Farm& farm, const Start& start) {
	auto error = std::make_shared<std::string>();
	auto bell = std::make_shared<Bell>(farm.io());
	start([error, bell](const std::string& what) {
		*error = what;
		bell->ring();
	});
	co_await bell->wait();
	if (!error->empty()) {
		farm.complain(*error);
		throw HttpError(507, *error);
	}
	farm.complain("");
}

} // namespace

Awaitable<void> Farm::commit(Ledger::Work work) {
	const auto start = [this, &work](Ledger::Done done) { ledger.post(std::move(work), std::move(done)); };
	co_await written(*this, start);
}

Awaitable<void> Farm::move(fs::path from, fs::path to) {
	const auto start = [this, &from, &to](Mover::Done done) { mover.move(from, to, std::move(done)); };
	co_await written(*this, start);
}

void Farm::note(Ledger::Work work) {
	ledger.post(std::move(work), [this](const std::string& error) {
		if (!error.empty())
			boost::asio::post(context, [this, error] {
				notes_lost = true;
				complain(error);
			});
	});
}

// A full disk is told of once, and that it is over once.
void Farm::complain(const std::string& what) {
	if (what.empty() && !complaint.empty())
		say("the spool takes what is written again");
	else if (!what.empty() && complaint.empty())
		say(what + "; what comes is turned away until that is mended, and comes again");
	if (what.empty() != complaint.empty())
		for (const auto& [id, job] : all_jobs)
			if (job.row.stage == Stage::running)
				events.job(id);
	complaint = what;
}

std::string Farm::doing(const Job& job) const {
	return job.row.stage == Stage::running && job.doing.empty() && !complaint.empty() ? waits_because(complaint) : job.doing;
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
	if (all_jobs.count(id))
		set_stage(all_jobs.at(id), to);
	wake(scheduler.waiting());
}

Awaitable<void> Farm::cancel(JobId id) {
	if (job(id).row.stage == Stage::done)
		throw HttpError(409, "job " + std::to_string(id) + " is done");
	Ledger::Work work = [=](Database& db) {
		rows::set_stage(db, id, Stage::cancelled, "", wall_time());
		rows::end_leases(db, id);
	};
	co_await commit(std::move(work));
	Changes changes;
	scheduler.forget_job(id, changes);
	apply(changes);
	if (all_jobs.count(id))
		set_stage(all_jobs.at(id), Stage::cancelled);
	auto clear = [this, id] { spool.remove_strips(id); };
	co_await in_pool(context, pool, clear);
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
	if (all_jobs.count(id))
		set_stage(all_jobs.at(id), Stage::running);
	wake(scheduler.waiting());
}

Awaitable<void> Farm::remove(JobId id) {
	job(id);
	auto clear = [this, id] { spool.remove_job(id); };
	// On a full disk the ledger cannot even note that something goes: the files make room first.
	if (!complaint.empty())
		co_await in_pool(context, pool, clear);
	Ledger::Work work = [=](Database& db) { rows::remove_job(db, id); };
	co_await commit(std::move(work));
	Changes changes;
	scheduler.forget_job(id, changes);
	apply(changes);
	all_jobs.erase(id);
	co_await in_pool(context, pool, clear);
	events.job(id);
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
