// SPDX-License-Identifier: AGPL-3.0-or-later
// The scheduler against a simulated clock and random events.
#include "distribute/schedule/scheduler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace farm;

namespace {

Rules unchecked() {
	Rules rules;
	rules.check_every = 0;
	return rules;
}

/// What a good worker finds on a strip, and what a liar says it found.
PixelHash truth(JobId job, int strip) { return static_cast<PixelHash>(job * 1000003 + strip + 1); }

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

TEST(Scheduler, LendsInOrderAndEndsTheJob) {
	Scheduler s(unchecked(), 100);
	s.add_job(1, 3, 0);
	s.add_worker("a", 1, 0);
	Changes changes;
	for (int strip = 0; strip < 3; ++strip) {
		const auto lease = s.take("a", 0);
		ASSERT_TRUE(lease);
		EXPECT_EQ(lease->strip, strip);
		EXPECT_EQ(lease->id, 100 + strip);
		EXPECT_TRUE(s.complete(lease->id, truth(1, strip), 1, changes));
	}
	EXPECT_FALSE(s.take("a", 2));
	EXPECT_EQ(changes.done, std::vector<JobId>{1});
	EXPECT_EQ(s.jobs().at(1).stage, Stage::done);
}

TEST(Scheduler, PrioritiesThenAge) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 1, 0);
	s.add_job(2, 1, 5);
	s.add_job(3, 1, 0);
	s.add_worker("a", 3, 0);
	EXPECT_EQ(s.take("a", 0)->job, 2);
	EXPECT_EQ(s.take("a", 0)->job, 1);
	s.set_paused(3, true);
	EXPECT_FALSE(s.take("a", 0));
	s.set_paused(3, false);
	EXPECT_EQ(s.take("a", 0)->job, 3);
}

TEST(Scheduler, SilenceEndsALeaseAndALateReportChangesNothing) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 1, 0);
	s.add_worker("a", 1, 0);
	s.add_worker("b", 1, 0);
	const Lease old = *s.take("a", 0);
	EXPECT_TRUE(s.beat("a", {old.id}, 15).empty());
	Changes changes;
	s.tick(34, changes);
	EXPECT_TRUE(changes.ended.empty()) << "20 s after the heartbeat are not over";
	s.tick(36, changes);
	ASSERT_EQ(changes.ended.size(), 1u);
	s.add_worker("b", 1, 36);
	const auto again = s.take("b", 36);
	ASSERT_TRUE(again);
	EXPECT_FALSE(s.complete(old.id, 666, 37, changes));
	EXPECT_TRUE(s.complete(again->id, truth(1, 0), 38, changes));
	EXPECT_EQ(s.jobs().at(1).result[0].hash, truth(1, 0));
	EXPECT_EQ(s.beat("a", {old.id}, 38), std::vector<LeaseId>{old.id});
}

TEST(Scheduler, SlowestStripsGoOutTwiceToSomebodyElse) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 3, 0);
	s.add_worker("slow", 1, 0);
	s.add_worker("quick", 1, 0);
	const Lease stuck = *s.take("slow", 0);
	Changes changes;
	for (int i = 0; i < 2; ++i)
		s.complete(s.take("quick", 5. * i)->id, truth(1, 1 + i), 5. * i + 5, changes);
	EXPECT_FALSE(s.take("slow", 12)) << "nobody is his own twin";
	EXPECT_TRUE(s.beat("slow", {stuck.id}, 9.9).empty());
	EXPECT_FALSE(s.take("quick", 9.9)) << "twice the mean, 10 s, is not over";
	const auto twin = s.take("quick", 10.1);
	ASSERT_TRUE(twin);
	EXPECT_EQ(twin->strip, 0);
	s.add_worker("third", 1, 11);
	EXPECT_FALSE(s.take("third", 30)) << "two are enough";
	EXPECT_TRUE(s.complete(twin->id, truth(1, 0), 12, changes));
	EXPECT_EQ(s.jobs().at(1).stage, Stage::done);
	EXPECT_EQ(s.beat("slow", {stuck.id}, 12), std::vector<LeaseId>{stuck.id}) << "the other may stop";
}

TEST(Scheduler, ABadStripIsTriedOnThreeWorkersAndGivenUp) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 2, 0);
	Changes changes;
	std::set<WorkerId> tried;
	for (const char* w : {"a", "b", "c", "d"})
		s.add_worker(w, 2, 0);
	for (const char* w : {"a", "a", "b", "c", "d"}) {
		const auto lease = s.take(w, 0);
		if (!lease || lease->strip != 0)
			continue; // it has failed that one before
		tried.insert(w);
		s.fail(lease->id, 0, changes);
	}
	EXPECT_EQ(tried, (std::set<WorkerId>{"a", "b", "c"}));
	ASSERT_EQ(changes.given_up.size(), 1u);
	EXPECT_EQ(s.jobs().at(1).stage, Stage::failed);
	EXPECT_FALSE(s.take("d", 100));
	s.retry(1);
	EXPECT_EQ(s.take("d", 100)->strip, 0);
}

TEST(Scheduler, AloneAWorkerTriesThreeTimes) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 1, 0);
	s.add_worker("a", 1, 0);
	Changes changes;
	Time now = 0;
	for (int i = 0; i < 3; ++i) {
		while (!s.leases().size() && now < 1000)
			if (!s.take("a", now += 0.5))
				s.tick(now, changes);
		s.fail(s.leases().begin()->first, now, changes);
	}
	EXPECT_EQ(changes.given_up.size(), 1u);
	EXPECT_LT(now, 10);
}

TEST(Scheduler, WhoFailsWhatOthersRenderIsSetAside) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 4, 0);
	s.add_worker("bad", 1, 0);
	s.add_worker("good", 1, 0);
	Changes changes;
	Time now = 0;
	for (int i = 0; i < 4; ++i) {
		if (const auto lease = s.take("bad", now += 10))
			s.fail(lease->id, now, changes);
		if (const auto lease = s.take("good", now))
			s.complete(lease->id, truth(1, lease->strip), now + 1, changes);
	}
	ASSERT_EQ(changes.aside.size(), 1u);
	EXPECT_EQ(changes.aside[0].first, "bad");
	EXPECT_FALSE(s.take("bad", now + 1000));
}

TEST(Scheduler, ALiarIsFoundOutAndWhatItSaidIsAskedAgain) {
	Rules rules;
	rules.check_every = 8;
	Scheduler s(rules, 1);
	s.add_job(1, 64, 0);
	for (const char* w : {"liar", "a", "b"})
		s.add_worker(w, 1, 0);
	Changes changes;
	Time now = 0;
	for (int round = 0; round < 1000 && s.jobs().at(1).stage != Stage::done; ++round)
		for (const char* w : {"liar", "a", "b"}) {
			now += 0.1;
			if (const auto lease = s.take(w, now)) {
				const bool lies = std::string(w) == "liar" && round > 3; // honest at first
				s.complete(lease->id, truth(1, lease->strip) + lies, now + 1, changes);
			}
			s.tick(now, changes);
		}
	ASSERT_EQ(s.jobs().at(1).stage, Stage::done);
	ASSERT_EQ(changes.aside.size(), 1u);
	EXPECT_EQ(changes.aside[0].first, "liar");
	for (int strip = 0; strip < 64; ++strip)
		EXPECT_EQ(s.jobs().at(1).result[static_cast<size_t>(strip)].hash, truth(1, strip)) << strip;
}

TEST(Scheduler, WithNobodyElseAnAnswerMustDo) {
	Rules rules;
	rules.check_every = 1;
	Scheduler s(rules, 1);
	s.add_job(1, 1, 0);
	s.add_worker("a", 1, 0);
	s.add_worker("b", 1, 0);
	Changes changes;
	s.complete(s.take("a", 0)->id, truth(1, 0), 1, changes);
	EXPECT_EQ(s.jobs().at(1).settled, 0);
	s.remove_worker("b", changes);
	for (Time t = 2; t < 40; ++t)
		s.tick(t, changes);
	EXPECT_EQ(s.jobs().at(1).stage, Stage::done);
}

TEST(Scheduler, RestoredFromItsOwnVotes) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 10, 0);
	Changes changes;
	std::map<int, std::vector<Vote>> votes;
	for (const int strip : {7, 2, 3})
		votes[strip].push_back({"a", truth(1, strip), true});
	s.restore_votes(1, votes, changes);
	s.restore_lease({5, 1, 4, "a", 0, 0}, 0);
	s.add_worker("a", 2, 0);
	std::vector<int> rest;
	while (const auto lease = s.take("a", 0)) {
		EXPECT_GT(lease->id, 5);
		rest.push_back(lease->strip);
	}
	EXPECT_EQ(rest, (std::vector<int>{0, 1, 5, 6, 8, 9}));
	EXPECT_TRUE(s.complete(5, truth(1, 4), 1, changes));
	EXPECT_EQ(s.jobs().at(1).settled, 4);
}

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
