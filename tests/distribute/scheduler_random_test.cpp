// SPDX-License-Identifier: AGPL-3.0-or-later
// The scheduler against a simulated clock and random events.
#include "distribute/schedule/scheduler.h"
#include "tests/distribute/truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace farm;

namespace {

/// A lab in which everything goes wrong now and then. Each step some worker does something; time goes on by a random amount.
class Lab {
public:
	Lab(unsigned seed, const Rules& rules) : random(seed), scheduler(rules, 1) {}

	std::mt19937 random;
	Scheduler scheduler;
	Time now = 0;
	std::map<WorkerId, std::vector<Lease>> hands;
	std::set<WorkerId> liars;
	std::vector<Lease> forgotten; // by workers that died, who may yet speak
	std::vector<LeaseId> seen;
	Changes all;

	bool chance(double p) { return std::uniform_real_distribution<>(0, 1)(random) < p; }

	void absorb(const Changes& c) {
		all.done.insert(all.done.end(), c.done.begin(), c.done.end());
		all.given_up.insert(all.given_up.end(), c.given_up.begin(), c.given_up.end());
		all.aside.insert(all.aside.end(), c.aside.begin(), c.aside.end());
	}

	void step(const WorkerId& worker, double trouble) {
		now += std::uniform_real_distribution<>(0, 0.2)(random);
		Changes changes;
		auto& hand = hands[worker];
		if (chance(trouble / 10)) { // dies; its leases are found out by silence
			forgotten.insert(forgotten.end(), hand.begin(), hand.end());
			hand.clear();
		}
		if (!forgotten.empty() && chance(0.1)) { // a late report, perhaps of a lease that has long ended
			const Lease late = forgotten.back();
			scheduler.complete(late.id, truth(late.job, late.strip), now, changes);
			if (chance(0.5))
				forgotten.pop_back();
		}
		if (!scheduler.workers().count(worker))
			scheduler.add_worker(worker, 2, now);
		std::vector<LeaseId> ids;
		for (const Lease& l : hand)
			ids.push_back(l.id);
		for (const LeaseId gone : scheduler.beat(worker, ids, now))
			hand.erase(std::remove_if(hand.begin(), hand.end(), [&](const Lease& l) { return l.id == gone; }), hand.end());
		if (hand.size() < 2) {
			if (const auto lease = scheduler.take(worker, now)) {
				EXPECT_TRUE(seen.empty() || lease->id > seen.back()) << "a lease's id came again";
				seen.push_back(lease->id);
				hand.push_back(*lease);
			}
		}
		if (!hand.empty() && chance(0.4)) {
			const Lease lease = hand.front();
			hand.erase(hand.begin());
			if (chance(trouble / 20))
				scheduler.give_back(lease.id);
			else if (chance(trouble / 50))
				scheduler.fail(lease.id, now, changes);
			else
				scheduler.complete(lease.id, truth(lease.job, lease.strip) + (liars.count(worker) ? 1 : 0), now, changes);
			EXPECT_EQ(scheduler.lease(lease.id), nullptr) << "a lease outlived its report";
			EXPECT_FALSE(scheduler.complete(lease.id, 7, now, changes)) << "a second report changed something";
		}
		scheduler.tick(now, changes);
		absorb(changes);
		check();
	}

	/// What must hold at any moment.
	void check() {
		for (const auto& [id, job] : scheduler.jobs()) {
			int settled = 0, waiting = 0, given_up = 0;
			for (int s = 0; s < job.strips; ++s) {
				const StripState state = job.state[static_cast<size_t>(s)];
				settled += state == StripState::settled;
				given_up += state == StripState::given_up;
				const bool waits = s >= job.next || job.returned.count(s);
				waiting += waits;
				ASSERT_EQ(waits, state == StripState::waiting) << "strip " << s;
				const auto out = job.out.find(s);
				ASSERT_LE(out == job.out.end() ? 0u : out->second.size(), 2u) << "strip " << s << " is out more than twice";
				ASSERT_TRUE(state != StripState::out || out != job.out.end()) << "strip " << s << " is lost";
			}
			ASSERT_EQ(settled, job.settled);
			ASSERT_EQ(waiting, job.waiting());
		}
		for (const auto& [id, lease] : scheduler.leases()) {
			const auto job = scheduler.jobs().find(lease.job);
			ASSERT_NE(job, scheduler.jobs().end());
			const auto& out = job->second.out.at(lease.strip);
			ASSERT_EQ(std::count(out.begin(), out.end(), id), 1);
		}
	}
};

class SchedulerAtRandom : public testing::TestWithParam<unsigned> {};

TEST_P(SchedulerAtRandom, EveryStripIsSettledOnceAndTruly) {
	Rules rules;
	rules.lease = 2;
	rules.tries = 1000; // failures are random here
	rules.blame = 1000;
	rules.losses = 1000;
	rules.check_every = 4;
	Lab lab(GetParam(), rules);
	lab.liars = {"w0"};
	std::vector<WorkerId> workers;
	for (int i = 0; i < 6; ++i)
		workers.push_back("w" + std::to_string(i));
	for (JobId job = 1; job <= 3; ++job)
		lab.scheduler.add_job(job, 30, static_cast<int>(job) % 2);
	int steps = 0;
	const auto over = [&] {
		return std::all_of(lab.scheduler.jobs().begin(), lab.scheduler.jobs().end(),
			[](const auto& j) { return j.second.stage == Stage::done; });
	};
	for (; !over() && steps < 200000 && !testing::Test::HasFatalFailure(); ++steps)
		lab.step(workers[lab.random() % workers.size()], steps < 3000 ? 1.0 : 0.1);
	ASSERT_TRUE(over()) << "not done after " << steps << " steps";
	EXPECT_TRUE(lab.all.given_up.empty());
	// A liar that is never checked may have got one past; one in four and each worker's first are.
	const bool caught = !lab.all.aside.empty();
	for (const auto& [id, job] : lab.scheduler.jobs())
		for (int s = 0; s < job.strips && caught; ++s)
			EXPECT_EQ(job.result[static_cast<size_t>(s)].hash, truth(id, s)) << "job " << id << " strip " << s;
	EXPECT_TRUE(caught);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SchedulerAtRandom, testing::Range(0u, 50u));

} // namespace
