// SPDX-License-Identifier: AGPL-3.0-or-later
// The scheduler against a simulated clock, decision by decision.
#include "distribute/schedule/scheduler.h"
#include "tests/distribute/truth.h"

#include <gtest/gtest.h>

using namespace farm;

namespace {

Rules unchecked() {
	Rules rules;
	rules.check_every = 0;
	return rules;
}

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

TEST(Scheduler, WhoRendersWhatItFailedBeforeIsNotToBlame) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 4, 0);
	s.add_worker("a", 1, 0);
	Changes changes;
	Time now = 0;
	for (int strip = 0; strip < 4; ++strip) {
		const auto bad = s.take("a", now += 100);
		ASSERT_TRUE(bad) << strip;
		s.fail(bad->id, now, changes);
		const auto good = s.take("a", now += 100);
		ASSERT_TRUE(good) << strip;
		EXPECT_EQ(good->strip, bad->strip);
		EXPECT_TRUE(s.complete(good->id, truth(1, strip), now, changes));
	}
	EXPECT_TRUE(changes.aside.empty());
	EXPECT_EQ(changes.done, std::vector<JobId>{1});
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

// It may have less memory than others; strips that fit are for it.
TEST(Scheduler, WhoMetItsOwnLimitIsNotToBlame) {
	Scheduler s(unchecked(), 1);
	s.add_job(1, 20, 0);
	s.add_worker("small", 1, 0);
	s.add_worker("large", 1, 0);
	Changes changes;
	Time now = 0;
	int failed = 0;
	for (int i = 0; i < 20; ++i) {
		if (const auto lease = s.take("small", now += 100)) {
			failed += lease->strip < 10;
			lease->strip < 10 ? s.fail(lease->id, now, changes, true)
							  : s.complete(lease->id, truth(1, lease->strip), now, changes);
		}
		if (const auto lease = s.take("large", now))
			s.complete(lease->id, truth(1, lease->strip), now + 1, changes);
	}
	EXPECT_GT(failed, 2);
	EXPECT_TRUE(changes.aside.empty());
	EXPECT_GT(s.workers().at("small").done, 0);
	EXPECT_EQ(s.jobs().at(1).stage, Stage::done);
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

// However many strips they differ about, each is named once.
TEST(Scheduler, WhereTwoDifferThereIsNoThirdToAsk) {
	Rules rules;
	rules.check_every = 1;
	Scheduler s(rules, 1);
	s.add_job(1, 3, 0);
	for (const char* w : {"a", "b"})
		s.add_worker(w, 1, 0);
	Changes changes;
	for (Time now = 0; now < 60 && s.jobs().at(1).stage == Stage::running; ++now) {
		for (const char* w : {"a", "b"})
			while (const auto lease = s.take(w, now))
				s.complete(lease->id, truth(1, lease->strip) + (*w == 'b'), now, changes);
		s.tick(now, changes);
	}
	EXPECT_EQ(s.jobs().at(1).stage, Stage::failed);
	EXPECT_EQ(changes.given_up.size(), 3u);
	const auto& names = changes.split.at(1);
	EXPECT_EQ(std::vector<WorkerId>(names.begin(), names.end()), (std::vector<WorkerId>{"a", "b"}));
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

} // namespace
