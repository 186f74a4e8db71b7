// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/store/ledger.h"

#include "distribute/common/error.h"

#include <nlohmann/json.hpp>

#include <future>

namespace farm {
namespace {

constexpr int ledger_version = 2;

const char* const schema = R"(
CREATE TABLE job(id INTEGER PRIMARY KEY AUTOINCREMENT, client_key TEXT, spec TEXT NOT NULL, stage INTEGER NOT NULL DEFAULT 0,
	error TEXT NOT NULL DEFAULT '', created REAL NOT NULL, ended REAL NOT NULL DEFAULT 0);
CREATE UNIQUE INDEX job_key ON job(client_key) WHERE client_key <> '';
CREATE TABLE lease(id INTEGER PRIMARY KEY, job INTEGER NOT NULL REFERENCES job ON DELETE CASCADE, strip INTEGER NOT NULL, worker TEXT NOT NULL);
CREATE INDEX lease_job ON lease(job);
CREATE TABLE report(job INTEGER NOT NULL REFERENCES job ON DELETE CASCADE, strip INTEGER NOT NULL, worker TEXT NOT NULL,
	pixels TEXT NOT NULL, seconds REAL NOT NULL, settled INTEGER NOT NULL, PRIMARY KEY(job, strip, worker));
CREATE TABLE failure(job INTEGER NOT NULL REFERENCES job ON DELETE CASCADE, strip INTEGER NOT NULL, worker TEXT NOT NULL,
	at REAL NOT NULL, line TEXT NOT NULL, log TEXT NOT NULL);
CREATE INDEX failure_job ON failure(job);
CREATE TABLE frame(job INTEGER NOT NULL REFERENCES job ON DELETE CASCADE, frame INTEGER NOT NULL, PRIMARY KEY(job, frame));
CREATE TABLE aside(worker TEXT PRIMARY KEY, why TEXT NOT NULL, at REAL NOT NULL);
CREATE TABLE meta(epoch INTEGER NOT NULL);
INSERT INTO meta VALUES(0);
)";

} // namespace

Ledger::Ledger(const std::filesystem::path& f) : file(f), database(f) {
	std::int64_t version = 0;
	{
		Statement s(database, "PRAGMA user_version");
		s.step();
		version = s.integer(0);
	}
	if (version == 0) {
		database.execute("BEGIN IMMEDIATE");
		database.execute(schema);
		database.execute(("PRAGMA user_version=" + std::to_string(ledger_version)).c_str());
		database.execute("COMMIT");
	} else if (version != ledger_version) {
		throw Error("the ledger " + file.string() + " is of version " + std::to_string(version) + ", this server's is " +
					std::to_string(ledger_version));
	} else if (const std::string damage = database.damage(); !damage.empty()) {
		throw Error("the ledger " + file.string() + " is damaged: " + damage);
	}
	reading = std::make_unique<Database>(file);
	thread = std::thread([this] { serve(); });
}

Ledger::~Ledger() {
	{
		const std::lock_guard lock(mutex);
		ending = true;
	}
	wake.notify_one();
	thread.join();
}

void Ledger::post(Work work, Done done) {
	{
		const std::lock_guard lock(mutex);
		queue.push_back({std::move(work), std::move(done)});
	}
	wake.notify_one();
}

void Ledger::write(const Work& work) {
	std::promise<std::string> result;
	post(work, [&](const std::string& error) { result.set_value(error); });
	if (const std::string error = result.get_future().get(); !error.empty())
		throw Error(error);
}

void Ledger::serve() {
	std::unique_lock lock(mutex);
	while (true) {
		wake.wait(lock, [this] { return ending || !queue.empty(); });
		if (queue.empty())
			return;
		std::vector<Entry> batch;
		batch.swap(queue);
		lock.unlock();

		std::vector<std::string> errors(batch.size());
		std::string whole;
		try {
			database.execute("BEGIN IMMEDIATE");
			for (size_t i = 0; i < batch.size(); ++i) {
				try {
					database.execute("SAVEPOINT one");
					batch[i].work(database);
					database.execute("RELEASE one");
				} catch (const std::exception& e) {
					errors[i] = e.what();
					database.execute("ROLLBACK TO one; RELEASE one");
				}
			}
			database.execute("COMMIT");
		} catch (const std::exception& e) {
			whole = e.what();
			try {
				database.execute("ROLLBACK");
			} catch (const Error&) { // a full disk has rolled it back already
			}
		}
		for (size_t i = 0; i < batch.size(); ++i)
			if (batch[i].done)
				batch[i].done(whole.empty() ? errors[i] : whole);
		lock.lock();
	}
}

std::vector<JobRow> Ledger::jobs() {
	std::vector<JobRow> all;
	Statement s(*reading, "SELECT id, spec, stage, error, created, ended FROM job ORDER BY id");
	while (s.step()) {
		JobRow row;
		row.id = s.integer(0);
		row.spec = parse_object(s.text(1)).get<JobSpec>();
		row.stage = static_cast<Stage>(s.integer(2));
		row.error = s.text(3);
		row.created = s.real(4);
		row.ended = s.real(5);
		all.push_back(std::move(row));
	}
	return all;
}

std::vector<ReportRow> Ledger::reports(JobId job) {
	std::vector<ReportRow> all;
	Statement s(*reading, "SELECT strip, worker, pixels, seconds, settled FROM report WHERE job = ? ORDER BY rowid");
	s << job;
	while (s.step())
		all.push_back({job, static_cast<int>(s.integer(0)), s.text(1), s.text(2), s.real(3), s.integer(4) != 0});
	return all;
}

std::vector<Lease> Ledger::leases() {
	std::vector<Lease> all;
	Statement s(*reading, "SELECT id, job, strip, worker FROM lease ORDER BY id");
	while (s.step())
		all.push_back({s.integer(0), s.integer(1), static_cast<int>(s.integer(2)), s.text(3), 0, 0});
	return all;
}

std::vector<std::pair<JobId, int>> Ledger::frames() {
	std::vector<std::pair<JobId, int>> all;
	Statement s(*reading, "SELECT job, frame FROM frame");
	while (s.step())
		all.emplace_back(s.integer(0), static_cast<int>(s.integer(1)));
	return all;
}

std::vector<std::pair<WorkerId, std::string>> Ledger::aside() {
	std::vector<std::pair<WorkerId, std::string>> all;
	Statement s(*reading, "SELECT worker, why FROM aside");
	while (s.step())
		all.emplace_back(s.text(0), s.text(1));
	return all;
}

// Ids of this run start at epoch * 2^42: no need to write each one down before it is used.
LeaseId Ledger::next_lease() {
	LeaseId next = 0;
	write([&](Database& db) {
		Statement(db, "UPDATE meta SET epoch = epoch + 1").run();
		Statement s(db, "SELECT epoch FROM meta");
		s.step();
		next = (s.integer(0) << 42) + 1;
	});
	return next;
}

std::vector<FailureRow> Ledger::failures(JobId job) {
	const std::lock_guard lock(reading_mutex);
	std::vector<FailureRow> all;
	Statement s(*reading, "SELECT strip, worker, at, line, log FROM failure WHERE job = ? ORDER BY rowid");
	s << job;
	while (s.step())
		all.push_back({job, static_cast<int>(s.integer(0)), s.text(1), s.real(2), s.text(3), s.text(4)});
	return all;
}

std::string Ledger::damage() {
	const std::lock_guard lock(reading_mutex);
	return reading->damage();
}

} // namespace farm
