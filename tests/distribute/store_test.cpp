// SPDX-License-Identifier: AGPL-3.0-or-later
// The ledger and the spool: what was acknowledged is there after a kill -9 at any moment.
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/store/ledger.h"
#include "distribute/store/spool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>

using namespace farm;

namespace {

struct Folder {
	ScratchFolder scratch{fs::temp_directory_path()};
	fs::path file(const char* name) const { return scratch.path() / name; }
};

JobSpec spec() {
	JobSpec s;
	s.name = "x";
	s.bundle = std::string(64, 'b');
	s.width = s.height = s.strip_rows = 32;
	return s;
}

ReportRow report(JobId job, int strip) { return {job, strip, "w", sha256(std::to_string(strip)), 1, false}; }

TEST(Ledger, RemembersEverything) {
	Folder f;
	JobId job = 0;
	LeaseId first = 0;
	{
		Ledger l(f.file("l"));
		first = l.next_lease();
		l.write([&](Database& db) {
			job = rows::add_job(db, spec(), 10);
			rows::add_lease(db, {first, job, 3, "w", 0, 0});
			rows::add_lease(db, {first + 1, job, 4, "v", 0, 0});
			rows::add_report(db, report(job, 1));
			rows::add_report(db, report(job, 2));
			rows::set_settled(db, job, 2, sha256("2").substr(0, 16));
			rows::set_settled(db, job, 1, "0123456789abcdef");
			rows::end_lease(db, first);
			rows::add_failure(db, {job, 5, "w", 11, "line", "log"});
			rows::set_frame(db, job, 7, true);
			rows::set_stage(db, job, Stage::paused, "why", 12);
		});
		JobId again = 0;
		l.write([&](Database& db) {
			JobSpec s = spec();
			s.client_key = "k";
			again = rows::add_job(db, s, 10);
			EXPECT_EQ(rows::add_job(db, s, 99), again) << "the same key is the same job";
		});
	}
	Ledger l(f.file("l"));
	const auto jobs = l.jobs();
	ASSERT_EQ(jobs.size(), 2u);
	EXPECT_EQ(jobs[0].stage, Stage::paused);
	EXPECT_EQ(jobs[0].error, "why");
	const auto leases = l.leases();
	ASSERT_EQ(leases.size(), 1u);
	EXPECT_EQ(leases[0].worker, "v");
	const auto reports = l.reports(job);
	ASSERT_EQ(reports.size(), 2u);
	EXPECT_FALSE(reports[0].settled);
	EXPECT_TRUE(reports[1].settled);
	EXPECT_EQ(l.failures(job).at(0).log, "log");
	EXPECT_EQ(l.frames(), (std::vector<std::pair<JobId, int>>{{job, 7}}));
	EXPECT_GT(l.next_lease(), first + 1000000);
	l.write([&](Database& db) { rows::remove_job(db, job); });
	EXPECT_TRUE(l.reports(job).empty());
	EXPECT_TRUE(l.leases().empty());
	// What was under way when it was removed, a frame being stitched and a strip going out, is no damage to the ledger.
	EXPECT_NO_THROW(l.write([&](Database& db) { rows::set_frame(db, job, 8, true); }));
	EXPECT_NO_THROW(l.write([&](Database& db) { rows::add_lease(db, {first + 2, job, 3, "w", 0, 0}); }));
	EXPECT_TRUE(l.leases().empty());
	EXPECT_EQ(l.damage(), "");
}

TEST(Ledger, WorkThatFailsHurtsNoOther) {
	Folder f;
	Ledger l(f.file("l"));
	JobId job = 0;
	l.write([&](Database& db) { job = rows::add_job(db, spec(), 1); });
	std::atomic<int> good = 0, bad = 0;
	for (int i = 0; i < 100; ++i)
		l.post(
			[=](Database& db) {
				rows::add_report(db, report(job, i));
				if (i % 3 == 0)
					rows::add_report(db, report(999, i)); // no such job
			},
			[&](const std::string& error) { ++(error.empty() ? good : bad); });
	l.write([](Database&) {});
	EXPECT_EQ(good, 66);
	EXPECT_EQ(bad, 34);
	EXPECT_EQ(l.reports(job).size(), 66u);
}

// A child writes strip after strip as the server does (file, fsync, rename, row), says each one that was acknowledged, and is
// killed at some moment.
TEST(Ledger, AcknowledgedSurvivesKill) {
	for (int round = 0; round < 12; ++round) {
		Folder f;
		int pipe[2];
		ASSERT_EQ(::pipe(pipe), 0);
		const pid_t child = ::fork();
		if (child == 0) {
			Ledger l(f.file("l"));
			JobId job = 0;
			l.write([&](Database& db) { job = rows::add_job(db, spec(), 1); });
			for (int i = 0; i < 100000; ++i) {
				write_durably(f.file(std::to_string(i).c_str()), std::to_string(i));
				l.post([=](Database& db) { rows::add_report(db, report(job, i)); },
					[=](const std::string& error) {
						if (error.empty() && ::write(pipe[1], &i, sizeof i) != sizeof i)
							::_exit(1);
					});
			}
			::_exit(0);
		}
		::close(pipe[1]);
		int told = -1, last = -1, count = 0;
		while (count < 5 + 7 * round && ::read(pipe[0], &told, sizeof told) == sizeof told)
			++count, last = told;
		::kill(child, SIGKILL);
		while (::read(pipe[0], &told, sizeof told) == sizeof told)
			last = told;
		::waitpid(child, nullptr, 0);
		::close(pipe[0]);
		ASSERT_GE(last, 4);
		Ledger l(f.file("l"));
		EXPECT_EQ(l.damage(), "");
		const auto rows = l.reports(1);
		ASSERT_GE(static_cast<int>(rows.size()), last + 1) << "something acknowledged is lost";
		for (const ReportRow& row : rows)
			EXPECT_EQ(read_file(f.file(std::to_string(row.strip).c_str())), std::to_string(row.strip))
				<< "a row without its file";
	}
}

TEST(Ledger, DamageIsToldAtStart) {
	Folder f;
	{
		Ledger l(f.file("l"));
		l.write([](Database& db) {
			for (int i = 0; i < 200; ++i)
				rows::add_job(db, spec(), i);
		});
	}
	{
		std::fstream file(f.file("l"), std::ios::in | std::ios::out | std::ios::binary);
		file.seekp(8 * 4096);
		file << std::string(4 * 4096, 'x');
	}
	EXPECT_THROW(Ledger(f.file("l")).jobs(), std::exception);
}

TEST(Spool, OneServerAtATimeAndFilesAreWhatTheirNamesSay) {
	Folder f;
	Spool spool(f.file("spool"));
	EXPECT_THROW(Spool(f.file("spool")), Error);
	const fs::path in = spool.fresh();
	std::ofstream(in) << "hello";
	EXPECT_THROW(spool.keep_file(in, std::string(64, '0')), Error);
	EXPECT_FALSE(spool.has_file(std::string(64, '0')));
	spool.keep_file(in, sha256("hello"));
	EXPECT_EQ(read_file(spool.file(sha256("hello"))), "hello");
	Bundle bundle;
	bundle.files = {{"a.pov", sha256("hello"), 5}};
	spool.keep_bundle(bundle);
	EXPECT_EQ(json(*spool.bundle(bundle.id())), json(bundle));
	spool.sweep({bundle.id()}, 0);
	EXPECT_TRUE(spool.has_file(sha256("hello")));
	spool.sweep({}, 1000);
	EXPECT_TRUE(spool.has_file(sha256("hello"))) << "not yet";
	::usleep(20000);
	spool.sweep({}, 0);
	EXPECT_FALSE(spool.has_file(sha256("hello")));
	EXPECT_FALSE(spool.bundle(bundle.id()));
}

TEST(Hash, KnownAnswers) { // FIPS 180-4's examples
	EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
	EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
	EXPECT_TRUE(same_secret("a", "a"));
	EXPECT_FALSE(same_secret("a", "ab"));
}

} // namespace
