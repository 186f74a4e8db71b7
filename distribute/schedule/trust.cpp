// SPDX-License-Identifier: AGPL-3.0-or-later
// Whose word is taken, and what rests on it.
#include "distribute/schedule/scheduler.h"

#include <algorithm>

namespace farm {

// Spot checks: a worker's strips until another has agreed with it, one at a time, and then one in so many, strewn by SplitMix64's
// finalizer (Steele, Lea and Flood, Fast splittable pseudorandom number generators, 2014) so that no rhythm of the farm keeps
// step with them.
bool Scheduler::wants_second(const JobState& j, int strip, const WorkerId& id) const {
	if (rules.check_every <= 0)
		return false;
	std::uint64_t z = (static_cast<std::uint64_t>(j.id) << 32) + static_cast<std::uint64_t>(strip);
	z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
	z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
	z ^= z >> 31;
	return (!j.confirmed.count(id) && !j.asked.count(id)) || z % static_cast<std::uint64_t>(rules.check_every) == 0;
}

// The strip waits for another than those that have voted on it.
void Scheduler::ask_another(JobState& j, int strip, const WorkerId& about) {
	j.trouble[strip].needed = 2;
	if (!j.confirmed.count(about))
		j.asked.emplace(about, strip);
}

void Scheduler::reopen(JobState& j, int strip, Changes& changes) {
	j.state[static_cast<size_t>(strip)] = StripState::waiting;
	--j.settled;
	if (j.stage == Stage::done)
		j.stage = Stage::running;
	changes.reopened.push_back({j.id, strip});
}

void Scheduler::doubt(JobState& j, bool only_gone, Time now, Changes& changes) {
	if (rules.check_every <= 0)
		return;
	for (const auto& [id, index] : j.names) {
		if (j.confirmed.count(id) || j.asked.count(id) || banned.count(id) || (only_gone && worker_states.count(id)))
			continue;
		int& doubts = j.doubts[id];
		for (int s = 0; s < j.next && doubts < rules.doubts && !j.asked.count(id); ++s) {
			const Settled result = j.result[static_cast<size_t>(s)];
			if (j.state[static_cast<size_t>(s)] != StripState::settled || result.worker != index || !somebody_else(j, s, now, id))
				continue;
			++doubts;
			reopen(j, s, changes);
			j.trouble[s].votes.assign(1, Vote{id, result.hash});
			ask_another(j, s, id);
			release(j, s);
		}
	}
}

void Scheduler::set_aside(const WorkerId& id, const std::string& why, Changes& changes) {
	const std::string lying = "its pixels";
	const bool lied = why.rfind(lying, 0) == 0;
	if (const auto known = banned.find(id); known != banned.end() && (!lied || known->second.rfind(lying, 0) == 0))
		return;
	banned[id] = why;
	if (WorkerState* w = worker(id)) {
		w->aside = why;
		const auto held = w->leases;
		for (const LeaseId l : held) {
			changes.ended.push_back(lease_states.at(l));
			give_back(l);
		}
	}
	changes.aside.emplace_back(id, why);
	if (!lied)
		return;
	// What rests on its word alone is asked again.
	for (auto& [job_id, j] : job_states) {
		const auto name = j.names.find(id);
		if (name == j.names.end() || j.stage == Stage::cancelled)
			continue;
		for (int s = 0; s < j.strips; ++s) {
			const auto at = static_cast<size_t>(s);
			if (j.state[at] == StripState::settled && j.result[at].worker == name->second) {
				reopen(j, s, changes);
				release(j, s);
			}
		}
		for (auto& [strip, t] : j.trouble) {
			t.votes.erase(
				std::remove_if(t.votes.begin(), t.votes.end(), [&](const Vote& v) { return v.worker == id; }), t.votes.end());
			t.needed = t.votes.empty() ? 1 : t.needed;
		}
	}
}

} // namespace farm
