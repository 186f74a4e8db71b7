// SPDX-License-Identifier: AGPL-3.0-or-later
// What becomes of the answers: votes, failures, silence.
#include "distribute/schedule/scheduler.h"

#include <algorithm>
#include <cmath>

namespace farm {
namespace {

std::string differs(JobId job, int strip) {
	return "its pixels of strip " + std::to_string(strip) + " of job " + std::to_string(job) + " differ from two others'";
}

} // namespace

bool Scheduler::complete(LeaseId id, PixelHash hash, Time now, Changes& changes) {
	const Lease* found = lease(id);
	if (!found)
		return false;
	const Lease lease = *found;
	end_lease(id);
	if (WorkerState* w = worker(lease.worker)) {
		w->heard = now;
		w->failures = 0;
		++w->done;
	}
	JobState& j = job_states.at(lease.job);
	j.seconds += now - lease.started;
	++j.timed;
	vote(j, lease.strip, lease.worker, hash, now, changes);
	return true;
}

void Scheduler::vote(JobState& j, int strip, const WorkerId& who, PixelHash hash, Time now, Changes& changes) {
	const auto at = static_cast<size_t>(strip);
	if (j.state[at] == StripState::settled) {
		// The second of two that were sent out, after the first.
		const int first = j.result[at].worker;
		if (first < 0) {
			if (j.result[at].hash != hash)
				set_aside(who, differs(j.id, strip), changes);
			return;
		}
		const auto name = std::find_if(j.names.begin(), j.names.end(), [&](const auto& n) { return n.second == first; });
		if (j.result[at].hash == hash) {
			if (name->first == who)
				return;
			j.result[at].worker = -1;
			j.names.emplace(who, static_cast<int>(j.names.size()));
			for (const WorkerId& id : {who, name->first}) {
				j.confirmed.insert(id);
				j.asked.erase(id);
			}
			return;
		}
		const Vote other{name->first, j.result[at].hash};
		reopen(j, strip, changes);
		j.trouble[strip].votes.assign(1, other);
		ask_another(j, strip, other.worker);
	}
	Trouble* t = j.trouble.count(strip) ? &j.trouble[strip] : nullptr;
	if (wants_second(j, strip, who) && somebody_else(j, strip, now, who)) {
		ask_another(j, strip, who);
		t = &j.trouble[strip];
	}
	j.names.emplace(who, static_cast<int>(j.names.size()));
	if (t) {
		if (std::none_of(t->votes.begin(), t->votes.end(), [&](const Vote& v) { return v.worker == who; }))
			t->votes.push_back({who, hash});
		const auto same = std::count_if(t->votes.begin(), t->votes.end(), [&](const Vote& v) { return v.hash == hash; });
		if (same < t->needed) {
			// With nobody to ask, what is there must do; `tick` sees to it.
			release(j, strip);
			return;
		}
	}
	settle(j, strip, who, hash, now, changes);
}

void Scheduler::settle(JobState& j, int strip, const WorkerId& who, PixelHash hash, Time now, Changes& changes) {
	const auto at = static_cast<size_t>(strip);
	const auto found = j.trouble.find(strip);
	const Trouble t = found == j.trouble.end() ? Trouble() : found->second;
	j.trouble.erase(strip);
	const auto agree = std::count_if(t.votes.begin(), t.votes.end(), [&](const Vote& v) { return v.hash == hash; });
	j.returned.erase(strip);
	for (; j.next <= strip; ++j.next) // restored
		if (j.next < strip)
			j.returned.insert(j.next);
	j.state[at] = StripState::settled;
	j.result[at] = Settled{hash, agree >= 2 ? -1 : j.names.at(who)};
	++j.settled;
	changes.settled.push_back({j.id, strip});
	// A twin that is still out may go on: its answer is a check that costs nothing more. The last strips' twins are stopped.
	if (j.settled == j.strips || j.stage != Stage::running)
		end_leases_of(j, strip, changes);
	update_ready(j);
	for (const Vote& v : t.votes) {
		j.asked.erase(v.worker);
		if (v.hash != hash)
			set_aside(v.worker, differs(j.id, strip), changes);
		else if (agree >= 2)
			j.confirmed.insert(v.worker);
	}
	// Who renders at a later try what it failed itself was unlucky, and may be the only worker there is.
	for (const WorkerId& id : t.failed_by)
		if (WorkerState* w = worker(id); w && id != who && !t.limited.count(id) && w->aside.empty() && ++w->blame >= rules.blame)
			set_aside(id, "it failed " + std::to_string(w->blame) + " strips that others rendered", changes);
	check_done(j, now, changes);
}

void Scheduler::check_done(JobState& j, Time now, Changes& changes) {
	if (j.settled < j.strips || j.stage == Stage::done || j.stage == Stage::cancelled)
		return;
	doubt(j, false, now, changes);
	if (j.settled < j.strips)
		return;
	j.stage = Stage::done;
	while (!j.out.empty())
		end_leases_of(j, j.out.begin()->first, changes);
	update_ready(j);
	changes.done.push_back(j.id);
}

bool Scheduler::fail(LeaseId id, Time now, Changes& changes, bool limited) {
	const Lease* found = lease(id);
	if (!found)
		return false;
	const Lease lease = *found;
	end_lease(id);
	if (WorkerState* w = worker(lease.worker)) {
		w->heard = now;
		if (++w->failures >= 2)
			w->rests_until = now + std::min(60.0, rules.rest * std::pow(2.0, std::min(w->failures - 2, 10)));
	}
	JobState& j = job_states.at(lease.job);
	if (j.state[static_cast<size_t>(lease.strip)] == StripState::settled)
		return true;
	Trouble& t = j.trouble[lease.strip];
	t.failed_by.insert(lease.worker);
	if (limited)
		t.limited.insert(lease.worker);
	++t.failures;
	// Three tries on as many workers, or by whoever there is; while others that have worked on this job are away, they are
	// waited for.
	const auto same_one = [&](const auto& n) { return t.failed_by.count(n.first) > 0; };
	const bool others = !std::all_of(j.names.begin(), j.names.end(), same_one);
	if (t.failures < rules.tries ||
		(others && static_cast<int>(t.failed_by.size()) < rules.tries && t.failures < 4 * rules.tries)) {
		release(j, lease.strip);
		return true;
	}
	give_up(j, lease.strip, changes);
	return true;
}

void Scheduler::give_up(JobState& j, int strip, Changes& changes) {
	end_leases_of(j, strip, changes);
	j.returned.erase(strip);
	j.state[static_cast<size_t>(strip)] = StripState::given_up;
	j.stage = Stage::failed;
	j.given_up = strip;
	update_ready(j);
	changes.given_up.push_back({j.id, strip});
}

void Scheduler::tick(Time now, Changes& changes) {
	std::vector<Lease> late;
	for (const auto& [id, lease] : lease_states)
		if (lease.expires < now)
			late.push_back(lease);
	for (const Lease& lease : late) {
		changes.ended.push_back(lease);
		end_lease(lease.id);
		JobState& j = job_states.at(lease.job);
		if (j.state[static_cast<size_t>(lease.strip)] == StripState::settled)
			continue;
		if (++j.trouble[lease.strip].losses >= rules.losses) {
			give_up(j, lease.strip, changes);
		} else {
			release(j, lease.strip);
		}
	}
	std::vector<WorkerId> gone;
	for (const auto& [id, w] : worker_states)
		if (w.leases.empty() && w.heard + rules.lease < now)
			gone.push_back(id);
	for (const WorkerId& id : gone) {
		// One that was set aside is remembered, or it would come back clean.
		if (worker_states.at(id).aside.empty())
			worker_states.erase(id);
		changes.gone.push_back(id);
	}
	// Strips that wait for a second opinion where there is nobody to give one.
	for (auto& [job_id, j] : job_states) {
		if (j.stage != Stage::running)
			continue;
		std::vector<std::pair<int, Vote>> enough;
		std::vector<int> split;
		for (auto& [strip, t] : j.trouble) {
			if (t.votes.empty() || j.out.count(strip) || somebody_else(j, strip, now)) {
				t.since = -1;
				continue;
			}
			if (t.since < 0)
				t.since = now;
			if (now - t.since < rules.check_patience)
				continue;
			// Where two differ and there is no third, nobody knows.
			if (t.votes.size() == 1)
				enough.emplace_back(strip, t.votes.front());
			else
				split.push_back(strip);
		}
		for (const auto& [strip, v] : enough)
			settle(j, strip, v.worker, v.hash, now, changes);
		for (const int strip : split) {
			for (const Vote& v : j.trouble[strip].votes)
				changes.split[job_id].insert(v.worker);
			give_up(j, strip, changes);
		}
		doubt(j, true, now, changes);
	}
}

} // namespace farm
