// SPDX-License-Identifier: AGPL-3.0-or-later
// Jobs, workers, and the lending of strips; votes.cpp has what becomes of the answers.
#include "distribute/schedule/scheduler.h"

#include <algorithm>
#include <cmath>

namespace farm {

Scheduler::Scheduler(const Rules& r, LeaseId first_lease) : rules(r), next_lease(first_lease) {}

JobState* Scheduler::job(JobId id) {
	const auto found = job_states.find(id);
	return found == job_states.end() ? nullptr : &found->second;
}

WorkerState* Scheduler::worker(const WorkerId& id) {
	const auto found = worker_states.find(id);
	return found == worker_states.end() ? nullptr : &found->second;
}

const Lease* Scheduler::lease(LeaseId id) const {
	const auto found = lease_states.find(id);
	return found == lease_states.end() ? nullptr : &found->second;
}

int Scheduler::waiting() const {
	int sum = 0;
	for (const auto& [order, id] : ready)
		sum += job_states.at(id).waiting();
	return sum;
}

StripState Scheduler::state(JobId id, int strip) const {
	const auto found = job_states.find(id);
	return found == job_states.end() || strip < 0 || strip >= found->second.strips
			   ? StripState::waiting
			   : found->second.state[static_cast<size_t>(strip)];
}

void Scheduler::update_ready(JobState& j) {
	const std::pair<int, JobId> key(-j.priority, j.id);
	if (j.stage == Stage::running && j.waiting() > 0)
		ready.insert(key);
	else
		ready.erase(key);
}

void Scheduler::add_job(JobId id, int strips, int priority) {
	JobState& j = job_states[id];
	j.id = id;
	j.strips = strips;
	j.priority = priority;
	j.state.assign(static_cast<size_t>(strips), StripState::waiting);
	j.result.resize(static_cast<size_t>(strips));
	update_ready(j);
}

void Scheduler::forget_job(JobId id, Changes& changes) {
	cancel(id, changes);
	job_states.erase(id);
}

void Scheduler::set_paused(JobId id, bool paused) {
	JobState* j = job(id);
	if (!j || (j->stage != Stage::running && j->stage != Stage::paused))
		return;
	j->stage = paused ? Stage::paused : Stage::running;
	update_ready(*j);
}

void Scheduler::cancel(JobId id, Changes& changes) {
	JobState* j = job(id);
	if (!j)
		return;
	while (!j->out.empty())
		end_leases_of(*j, j->out.begin()->first, changes);
	if (j->stage != Stage::done && j->stage != Stage::failed)
		j->stage = Stage::cancelled;
	update_ready(*j);
}

void Scheduler::retry(JobId id) {
	JobState* j = job(id);
	if (!j || (j->stage != Stage::failed && j->stage != Stage::cancelled))
		return;
	j->stage = Stage::running;
	j->given_up = -1;
	for (int s = 0; s < j->next; ++s)
		if (j->state[static_cast<size_t>(s)] == StripState::given_up) {
			j->trouble.erase(s);
			for (auto asked = j->asked.begin(); asked != j->asked.end();)
				asked = asked->second == s ? j->asked.erase(asked) : std::next(asked);
			release(*j, s);
		}
	update_ready(*j);
}

void Scheduler::add_worker(const WorkerId& id, int slots, Time now, bool pardon) {
	WorkerState& w = worker_states[id];
	w.slots = slots;
	w.heard = w.asks = now;
	w.draining = false;
	if (pardon) {
		banned.erase(id);
		w.blame = w.failures = 0;
		w.rests_until = 0;
	}
	const auto known = banned.find(id);
	w.aside = known == banned.end() ? "" : known->second;
}

void Scheduler::remove_worker(const WorkerId& id, Changes& changes) {
	WorkerState* w = worker(id);
	if (!w)
		return;
	const auto held = w->leases;
	for (const LeaseId l : held) {
		changes.ended.push_back(lease_states.at(l));
		give_back(l);
	}
	worker_states.erase(id);
}

void Scheduler::drain(const WorkerId& id, bool draining) {
	if (WorkerState* w = worker(id))
		w->draining = draining;
}

// Whether there is a worker that has neither failed this strip, nor given it back, nor said anything about it, and that works or
// asks for work.
bool Scheduler::somebody_else(const JobState& j, int strip, Time now, const WorkerId& than) const {
	const auto found = j.trouble.find(strip);
	for (const auto& [id, w] : worker_states) {
		if (!w.aside.empty() || w.draining || id == than || (w.leases.empty() && w.asks + rules.absent < now))
			continue;
		const auto voted = [&id = id](const Vote& v) { return v.worker == id; };
		if (found == j.trouble.end() || (!found->second.failed_by.count(id) && !found->second.returned_by.count(id) &&
											std::none_of(found->second.votes.begin(), found->second.votes.end(), voted)))
			return true;
	}
	return false;
}

bool Scheduler::may_take(const JobState& j, int strip, const WorkerId& id, Time now) const {
	const auto found = j.trouble.find(strip);
	if (found == j.trouble.end())
		return true;
	const Trouble& t = found->second;
	// One worker has one vote.
	if (std::any_of(t.votes.begin(), t.votes.end(), [&](const Vote& v) { return v.worker == id; }))
		return false;
	return !t.failed_by.count(id) || !somebody_else(j, strip, now);
}

std::optional<int> Scheduler::first_waiting(JobState& j, const WorkerId& id, Time now) {
	for (const int strip : j.returned)
		if (may_take(j, strip, id, now))
			return strip;
	return j.next < j.strips ? std::optional<int>(j.next) : std::nullopt;
}

std::optional<StripRef> Scheduler::straggler(const WorkerId& id, Time now) {
	for (const LeaseId l : alone) {
		const Lease& lease = lease_states.at(l);
		const double age = now - lease.started;
		if (age < rules.straggler_least)
			break; // the others are younger
		JobState& j = job_states.at(lease.job);
		const double enough = j.timed ? rules.straggler * j.seconds / j.timed : rules.straggler_first;
		const bool open = j.stage == Stage::running && j.state[static_cast<size_t>(lease.strip)] == StripState::out;
		if (lease.worker != id && open && age >= enough && may_take(j, lease.strip, id, now))
			return StripRef{lease.job, lease.strip};
	}
	return std::nullopt;
}

Lease Scheduler::lend(JobState& j, int strip, const WorkerId& id, Time now) {
	Lease lease{next_lease, j.id, strip, id, now, now + rules.lease};
	restore_lease(lease, now);
	next_lease += static_cast<LeaseId>(chance() % static_cast<unsigned>(rules.lease_gap));
	return lease;
}

std::optional<Lease> Scheduler::take(const WorkerId& id, Time now) {
	WorkerState* w = worker(id);
	if (!w)
		return std::nullopt;
	w->heard = w->asks = now;
	if (!w->aside.empty() || w->draining || now < w->rests_until)
		return std::nullopt;
	for (const auto& [order, job_id] : ready) {
		JobState& j = job_states.at(job_id);
		if (const auto strip = first_waiting(j, id, now))
			return lend(j, *strip, id, now);
	}
	if (const auto slow = straggler(id, now))
		return lend(job_states.at(slow->job), slow->strip, id, now);
	return std::nullopt;
}

std::vector<LeaseId> Scheduler::beat(const WorkerId& id, const std::vector<LeaseId>& held, Time now) {
	std::vector<LeaseId> ended;
	WorkerState* w = worker(id);
	if (w)
		w->heard = now;
	for (const LeaseId l : held) {
		const auto found = lease_states.find(l);
		if (!w || found == lease_states.end() || found->second.worker != id) {
			ended.push_back(l);
		} else {
			found->second.expires = now + rules.lease;
			w->leases.insert(l);
		}
	}
	return ended;
}

void Scheduler::end_lease(LeaseId id) {
	const auto found = lease_states.find(id);
	if (found == lease_states.end())
		return;
	const Lease lease = found->second;
	lease_states.erase(found);
	alone.erase(id);
	if (WorkerState* w = worker(lease.worker))
		w->leases.erase(id);
	JobState* j = job(lease.job);
	if (!j)
		return;
	auto& out = j->out[lease.strip];
	out.erase(std::remove(out.begin(), out.end(), id), out.end());
	if (out.size() == 1)
		alone.insert(out.front());
	if (out.empty())
		j->out.erase(lease.strip);
}

void Scheduler::end_leases_of(JobState& j, int strip, Changes& changes) {
	const auto out = j.out.find(strip);
	if (out == j.out.end())
		return;
	const auto ids = out->second;
	for (const LeaseId l : ids) {
		changes.ended.push_back(lease_states.at(l));
		end_lease(l);
	}
	release(j, strip);
}

// A strip that nobody has any more waits again.
void Scheduler::release(JobState& j, int strip) {
	StripState& s = j.state[static_cast<size_t>(strip)];
	if (j.out.count(strip) || s == StripState::settled)
		return;
	s = StripState::waiting;
	if (strip < j.next)
		j.returned.insert(strip);
	update_ready(j);
}

bool Scheduler::give_back(LeaseId id) {
	const Lease* found = lease(id);
	if (!found)
		return false;
	const Lease lease = *found;
	end_lease(id);
	if (JobState* j = job(lease.job)) {
		// An opinion that is waited for will not come from here.
		if (const auto t = j->trouble.find(lease.strip); t != j->trouble.end())
			t->second.returned_by.insert(lease.worker);
		release(*j, lease.strip);
	}
	return true;
}

} // namespace farm
