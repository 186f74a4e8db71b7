// SPDX-License-Identifier: AGPL-3.0-or-later
// What becomes of the answers: votes, failures, silence.
#include "distribute/schedule/scheduler.h"

#include <algorithm>
#include <cmath>

namespace farm {

// Spot checks: a worker's first strip of a job, and then one in so many, strewn by SplitMix64's finalizer (Steele, Lea and Flood,
// Fast splittable pseudorandom number generators, 2014) so that no rhythm of the farm keeps step with them.
bool Scheduler::wants_second(const JobState& j, int strip, const WorkerId& id) const {
	if (rules.check_every <= 0)
		return false;
	std::uint64_t z = (static_cast<std::uint64_t>(j.id) << 32) + static_cast<std::uint64_t>(strip);
	z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
	z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
	z ^= z >> 31;
	return !j.names.count(id) || z % static_cast<std::uint64_t>(rules.check_every) == 0;
}

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
	vote(j, lease.strip, lease.worker, hash, changes);
	return true;
}

void Scheduler::restore_vote(JobId id, int strip, const WorkerId& who, PixelHash hash, bool settled, Changes& changes) {
	JobState* j = job(id);
	if (!j || strip < 0 || strip >= j->strips || j->state[static_cast<size_t>(strip)] == StripState::settled)
		return;
	for (; j->next <= strip; ++j->next)
		j->returned.insert(j->next);
	j->names.emplace(who, static_cast<int>(j->names.size()));
	if (settled) {
		settle(*j, strip, who, hash, changes);
		return;
	}
	Trouble& t = j->trouble[strip];
	t.needed = 2;
	t.votes.push_back({who, hash});
}

void Scheduler::vote(JobState& j, int strip, const WorkerId& who, PixelHash hash, Changes& changes) {
	const auto at = static_cast<size_t>(strip);
	if (j.state[at] == StripState::settled) {
		// The second of two that were sent out, after the first.
		if (j.result[at].hash == hash || j.result[at].worker < 0)
			return;
		const int first = j.result[at].worker;
		const auto name = std::find_if(j.names.begin(), j.names.end(), [&](const auto& n) { return n.second == first; });
		j.state[at] = StripState::waiting;
		--j.settled;
		if (j.stage == Stage::done)
			j.stage = Stage::running;
		Trouble& t = j.trouble[strip];
		t.needed = 2;
		t.votes.assign(1, Vote{name->first, j.result[at].hash});
		changes.reopened.push_back({j.id, strip});
	}
	Trouble* t = j.trouble.count(strip) ? &j.trouble[strip] : nullptr;
	if (wants_second(j, strip, who) && somebody_else(j, strip, who)) {
		t = &j.trouble[strip];
		t->needed = 2;
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
	settle(j, strip, who, hash, changes);
}

void Scheduler::settle(JobState& j, int strip, const WorkerId& who, PixelHash hash, Changes& changes) {
	const auto at = static_cast<size_t>(strip);
	const auto found = j.trouble.find(strip);
	const Trouble t = found == j.trouble.end() ? Trouble() : found->second;
	j.trouble.erase(strip);
	const auto agree = std::count_if(t.votes.begin(), t.votes.end(), [&](const Vote& v) { return v.hash == hash; });
	j.returned.erase(strip);
	if (strip >= j.next) // restored
		j.next = strip + 1;
	j.state[at] = StripState::settled;
	j.result[at] = Settled{hash, agree >= 2 ? -1 : j.names.at(who)};
	++j.settled;
	changes.settled.push_back({j.id, strip});
	// A twin that is still out may go on: its answer is a check that costs nothing more. The last strips' twins are stopped.
	if (j.settled == j.strips || j.stage != Stage::running) {
		const auto out = j.out.find(strip);
		const auto ids = out == j.out.end() ? std::vector<LeaseId>() : out->second;
		for (const LeaseId l : ids) {
			changes.ended.push_back(lease_states.at(l));
			end_lease(l);
		}
	}
	update_ready(j);
	for (const Vote& v : t.votes)
		if (v.hash != hash)
			set_aside(v.worker,
				"its pixels of strip " + std::to_string(strip) + " of job " + std::to_string(j.id) + " differ from two others'",
				changes);
	for (const WorkerId& id : t.failed_by)
		if (WorkerState* w = worker(id); w && w->aside.empty() && ++w->blame >= rules.blame)
			set_aside(id, "it failed " + std::to_string(w->blame) + " strips that others rendered", changes);
	check_done(j, changes);
}

void Scheduler::check_done(JobState& j, Changes& changes) {
	if (j.settled < j.strips || j.stage == Stage::done || j.stage == Stage::cancelled)
		return;
	j.stage = Stage::done;
	while (!j.out.empty()) {
		const auto ids = j.out.begin()->second;
		for (const LeaseId l : ids) {
			changes.ended.push_back(lease_states.at(l));
			end_lease(l);
		}
	}
	update_ready(j);
	changes.done.push_back(j.id);
}

void Scheduler::set_aside(const WorkerId& id, const std::string& why, Changes& changes) {
	WorkerState* w = worker(id);
	if (w && !w->aside.empty())
		return;
	if (w) {
		w->aside = why;
		const auto held = w->leases;
		for (const LeaseId l : held) {
			changes.ended.push_back(lease_states.at(l));
			give_back(l);
		}
	}
	changes.aside.emplace_back(id, why);
	if (why.rfind("its pixels", 0) != 0)
		return;
	// What rests on its word alone is asked again.
	for (auto& [job_id, j] : job_states) {
		const auto name = j.names.find(id);
		if (name == j.names.end() || j.stage == Stage::cancelled)
			continue;
		for (int s = 0; s < j.strips; ++s) {
			const auto at = static_cast<size_t>(s);
			if (j.state[at] == StripState::settled && j.result[at].worker == name->second) {
				j.state[at] = StripState::waiting;
				--j.settled;
				if (j.stage == Stage::done)
					j.stage = Stage::running;
				release(j, s);
				changes.reopened.push_back({j.id, s});
			}
		}
		for (auto& [strip, t] : j.trouble)
			t.votes.erase(
				std::remove_if(t.votes.begin(), t.votes.end(), [&](const Vote& v) { return v.worker == id; }), t.votes.end());
	}
}

bool Scheduler::fail(LeaseId id, Time now, Changes& changes) {
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
	if (++t.failures < rules.tries) {
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

void Scheduler::restore_failed(JobId id) {
	if (JobState* j = job(id)) {
		j->stage = Stage::failed;
		update_ready(*j);
	}
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
			if (t.votes.empty() || j.out.count(strip) || somebody_else(j, strip)) {
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
			settle(j, strip, v.worker, v.hash, changes);
		for (const int strip : split)
			give_up(j, strip, changes);
	}
}

} // namespace farm
