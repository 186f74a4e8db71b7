// SPDX-License-Identifier: AGPL-3.0-or-later
// After a restart: what was known before.
#include "distribute/schedule/scheduler.h"

#include <algorithm>

namespace farm {

void Scheduler::restore_votes(JobId id, const std::map<int, std::vector<Vote>>& all, Changes& changes) {
	JobState* j = job(id);
	if (!j)
		return;
	for (const auto& [strip, votes] : all)
		for (const Vote& v : votes)
			j->names.emplace(v.worker, static_cast<int>(j->names.size()));
	std::map<int, std::vector<Vote>> unsure;
	for (const auto& [strip, votes] : all) {
		if (strip < 0 || strip >= j->strips)
			continue;
		const auto two = std::find_if(votes.begin(), votes.end(), [&votes = votes](const Vote& v) {
			return std::count_if(votes.begin(), votes.end(), [&](const Vote& o) { return o.hash == v.hash; }) >= 2;
		});
		if (two == votes.end()) {
			unsure[strip] = votes;
			continue;
		}
		j->trouble[strip].votes = votes;
		settle(*j, strip, two->worker, two->hash, 0, changes);
	}
	for (auto& [strip, votes] : unsure) {
		votes.erase(std::remove_if(votes.begin(), votes.end(), [this](const Vote& v) { return banned.count(v.worker) > 0; }),
			votes.end());
		if (votes.size() == 1 && (votes[0].settled || rules.check_every <= 0)) {
			settle(*j, strip, votes[0].worker, votes[0].hash, 0, changes);
		} else if (!votes.empty()) {
			for (; j->next <= strip; ++j->next)
				j->returned.insert(j->next);
			j->trouble[strip].votes = votes;
			ask_another(*j, strip, votes[0].worker);
		}
	}
	update_ready(*j);
}

void Scheduler::restore_failed(JobId id) {
	if (JobState* j = job(id)) {
		j->stage = Stage::failed;
		update_ready(*j);
	}
}

void Scheduler::restore_lease(const Lease& old, Time now) {
	JobState* j = job(old.job);
	if (!j || old.strip < 0 || old.strip >= j->strips || j->state[static_cast<size_t>(old.strip)] == StripState::settled)
		return;
	Lease lease = old;
	// When a lease of before began is not known by this run's clock.
	lease.started = old.started > 0 ? old.started : now;
	lease.expires = now + rules.lease;
	next_lease = std::max(next_lease, lease.id + 1);
	for (; j->next <= lease.strip; ++j->next)
		if (j->state[static_cast<size_t>(j->next)] == StripState::waiting)
			j->returned.insert(j->next);
	j->returned.erase(lease.strip);
	j->state[static_cast<size_t>(lease.strip)] = StripState::out;
	auto& out = j->out[lease.strip];
	out.push_back(lease.id);
	if (out.size() == 1)
		alone.insert(lease.id);
	else
		alone.erase(out.front());
	lease_states[lease.id] = lease;
	if (WorkerState* w = worker(lease.worker))
		w->leases.insert(lease.id);
	update_ready(*j);
}

} // namespace farm
