// SPDX-License-Identifier: AGPL-3.0-or-later
// The workers' side of the farm: they come, take strips, answer, and go.
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/server/farm.h"
#include "distribute/stitch/picture.h"

#include <algorithm>

namespace farm {
namespace {

std::string has_ended(LeaseId id) { return "lease " + std::to_string(id) + " has ended"; }

HttpError stranger(const WorkerId& worker) { return {404, "this server does not know worker " + worker + "; say hello first"}; }

} // namespace

// All workers make the same pixels as those that are here and get work. Who is to leave, or was set aside, has no say: that is
// how somebody's wrong first one is got rid of.
void Farm::welcome(const Hello& hello, const std::string& from) {
	for (const auto& [id, other] : all_guests) {
		const auto state = scheduler.workers().find(id);
		if (id == hello.id || state == scheduler.workers().end() || state->second.draining || !state->second.aside.empty())
			continue;
		const char* const way = "; if that is the wrong one, 'bhfarm drain' it";
		if (other.hello.povray != hello.povray)
			throw HttpError(409, hello.name + " is turned away: its povray is '" + hello.povray + "', that of " +
									 other.hello.name + ", which is here, '" + other.hello.povray + "'" + way);
		if (other.hello.probe != hello.probe)
			throw HttpError(409, hello.name + " is turned away: its povray makes other pixels than that of " + other.hello.name +
									 ", which is here" + way);
		break;
	}
	Guest& guest = all_guests[hello.id];
	scheduler.add_worker(hello.id, hello.slots, now(), false);
	if (guest.hello.id.empty()) {
		guest.since = wall_time();
		if (const std::string& why = scheduler.workers().at(hello.id).aside; !why.empty())
			say("worker " + hello.name + " is set aside: " + why);
		say("worker " + hello.name + " from " + from + " has " + std::to_string(hello.slots) +
			(hello.slots == 1 ? " slot" : " slots"));
	}
	guest.hello = hello;
	guest.from = from;
	events.worker(hello.id);
}

Awaitable<void> Farm::leave(WorkerId worker) {
	Changes changes;
	scheduler.remove_worker(worker, changes);
	if (const auto guest = all_guests.find(worker); guest != all_guests.end()) {
		say("worker " + guest->second.hello.name + " leaves");
		all_guests.erase(guest);
	}
	apply(changes);
	events.worker(worker);
	co_return;
}

void Farm::drain(const WorkerId& worker, bool draining) {
	if (!all_guests.count(worker))
		throw HttpError(404, "there is no worker " + worker);
	scheduler.drain(worker, draining);
	events.worker(worker);
}

Awaitable<std::optional<Task>> Farm::take(WorkerId worker, double wait, std::shared_ptr<Peer> peer) {
	const Time until = now() + wait;
	while (true) {
		if (!scheduler.workers().count(worker))
			throw stranger(worker);
		if (const auto lease = scheduler.take(worker, now())) {
			Ledger::Work work = [l = *lease](Database& db) { rows::add_lease(db, l); };
			try {
				co_await commit(std::move(work));
			} catch (const HttpError&) {
				scheduler.give_back(lease->id);
				throw;
			}
			const auto found = all_jobs.find(lease->job);
			if (peer->gone) {
				co_await give_back(lease->id);
				co_return std::nullopt;
			}
			if (!scheduler.lease(lease->id) || found == all_jobs.end())
				continue; // cancelled meanwhile
			const JobSpec& spec = found->second.row.spec;
			Task task;
			task.lease = lease->id;
			task.job = lease->job;
			task.frame = spec.frame_of(lease->strip);
			task.row = spec.row_of(lease->strip);
			task.rows = spec.rows_of(lease->strip);
			task.spec = spec;
			events.strip(task.job, lease->strip, worker);
			co_return task;
		}
		const double left = until - now();
		if (left <= 0 || peer->gone)
			co_return std::nullopt;
		auto bell = std::make_shared<Bell>(context);
		sleepers.push_back(bell);
		peer->tell = [bell] { bell->ring(); };
		if (!co_await bell->wait(left) || peer->gone)
			sleepers.erase(std::remove(sleepers.begin(), sleepers.end(), bell), sleepers.end());
	}
}

std::vector<LeaseId> Farm::beat(const WorkerId& worker, const std::vector<LeaseId>& leases) {
	if (!scheduler.workers().count(worker))
		throw stranger(worker);
	return scheduler.beat(worker, leases, now());
}

Awaitable<std::string> Farm::report(LeaseId id, fs::path file, std::string sha256, double seconds) {
	const Lease* known = scheduler.lease(id);
	if (!known)
		co_return has_ended(id);
	const Lease lease = *known;
	// The checks below must not outlast it.
	scheduler.beat(lease.worker, {id}, now());
	const JobSpec spec = job(lease.job).row.spec;

	struct Checked {
		std::string pixels, kind, damage;
		bool torn = false;
	};
	auto check = [=, this] {
		Checked c;
		c.torn = sha256_file(file) != sha256;
		if (c.torn)
			return c;
		try {
			c.pixels = check_strip(spec, spec.row_of(lease.strip), spec.rows_of(lease.strip), file);
			c.kind = kind_of(spec.format, file);
		} catch (const Error& e) {
			c.damage = e.what();
			return c;
		}
		return c;
	};
	Checked checked = co_await in_pool(context, pool, std::move(check));
	if (checked.torn)
		throw HttpError(422, "the strip was damaged on its way: send it again");
	if (const auto found = all_jobs.find(lease.job); found != all_jobs.end() && !checked.kind.empty()) {
		std::string& kind = found->second.kind;
		if (kind.empty())
			kind = checked.kind;
		else if (kind != checked.kind)
			checked.damage = "it is " + checked.kind + "; the job's others are " + kind;
	}
	if (!checked.damage.empty()) {
		Failure failure;
		failure.line = "the worker sent no good picture: " + checked.damage;
		const std::string why = failure.line, ended = co_await failed(id, std::move(failure));
		co_return ended.empty() ? why : ended;
	}
	co_await move(file, spool.strip(lease.job, lease.strip, checked.pixels, spec.suffix()));
	// The ledger is the fence: of two reports that come at once it takes one.
	const ReportRow report{lease.job, lease.strip, lease.worker, checked.pixels, seconds, false};
	auto held = std::make_shared<bool>(false);
	Ledger::Work work = [=](Database& db) {
		*held = rows::end_lease(db, id);
		if (*held)
			rows::add_report(db, report);
	};
	co_await commit(std::move(work));
	if (!*held)
		co_return has_ended(id);
	Changes changes;
	const bool taken = scheduler.complete(id, std::stoull(checked.pixels.substr(0, 16), nullptr, 16), now(), changes);
	apply(changes);
	events.strip(lease.job, lease.strip, lease.worker);
	co_return taken ? "" : has_ended(id);
}

Awaitable<std::string> Farm::failed(LeaseId id, Failure failure) {
	const Lease* known = scheduler.lease(id);
	if (!known)
		co_return has_ended(id);
	const Lease lease = *known;
	const std::string name = name_of(lease.worker);
	say("job " + std::to_string(lease.job) + ", " + place(job(lease.job).row.spec, lease.strip) + " failed on " + name + ": " +
		failure.line);
	Ledger::Work work = [=](Database& db) {
		if (rows::end_lease(db, id))
			rows::add_failure(db, {lease.job, lease.strip, name, wall_time(), failure.line, failure.log});
	};
	co_await commit(std::move(work));
	Changes changes;
	scheduler.fail(id, now(), changes, failure.limited);
	apply(changes);
	events.strip(lease.job, lease.strip, lease.worker);
	events.failure({{"job", lease.job}, {"strip", lease.strip}, {"worker", name}, {"line", failure.line}});
	wake(1);
	co_return "";
}

Awaitable<std::string> Farm::give_back(LeaseId id) {
	if (const Lease* lease = scheduler.lease(id))
		events.strip(lease->job, lease->strip, lease->worker);
	const bool known = scheduler.give_back(id);
	note([id](Database& db) { rows::end_lease(db, id); });
	wake(1);
	co_return known ? "" : has_ended(id);
}

} // namespace farm
