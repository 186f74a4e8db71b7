// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/store/ledger.h"

#include <nlohmann/json.hpp>

namespace farm::rows {

JobId add_job(Database& db, const JobSpec& spec, double now) {
	if (!spec.client_key.empty()) {
		Statement known(db, "SELECT id FROM job WHERE client_key = ?");
		known << spec.client_key;
		if (known.step())
			return known.integer(0);
	}
	Statement s(db, "INSERT INTO job(client_key, spec, created) VALUES(?, ?, ?)");
	(s << spec.client_key << json(spec).dump() << now).run();
	return db.last_id();
}

void set_stage(Database& db, JobId job, Stage stage, const std::string& error, double now) {
	const bool over = stage == Stage::done || stage == Stage::failed || stage == Stage::cancelled;
	Statement s(db, "UPDATE job SET stage = ?, error = ?, ended = ? WHERE id = ?");
	(s << static_cast<int>(stage) << error << (over ? now : 0.0) << job).run();
}

void remove_job(Database& db, JobId job) {
	Statement s(db, "DELETE FROM job WHERE id = ?");
	(s << job).run();
}

void add_lease(Database& db, const Lease& lease) {
	// Of a job that was removed a moment ago there is nothing to note, which is no trouble.
	Statement s(db, "INSERT INTO lease(id, job, strip, worker) SELECT ?, id, ?, ? FROM job WHERE id = ?");
	(s << lease.id << lease.strip << lease.worker << lease.job).run();
}

bool end_lease(Database& db, LeaseId lease) {
	Statement s(db, "DELETE FROM lease WHERE id = ?");
	(s << lease).run();
	return db.changed() > 0;
}

void end_leases(Database& db, JobId job) {
	Statement s(db, "DELETE FROM lease WHERE job = ?");
	(s << job).run();
}

void add_report(Database& db, const ReportRow& row) {
	Statement s(db,
		"INSERT INTO report(job, strip, worker, pixels, seconds, settled) VALUES(?, ?, ?, ?, ?, ?) ON CONFLICT DO UPDATE "
		"SET pixels = excluded.pixels, seconds = excluded.seconds");
	(s << row.job << row.strip << row.worker << row.pixels << row.seconds << int(row.settled)).run();
}

void set_settled(Database& db, JobId job, int strip, const std::string& pixels) {
	Statement s(db, "UPDATE report SET settled = (substr(pixels, 1, 16) = ?) WHERE job = ? AND strip = ?");
	(s << pixels << job << strip).run();
}

void add_failure(Database& db, const FailureRow& row) {
	Statement s(db, "INSERT INTO failure(job, strip, worker, at, line, log) VALUES(?, ?, ?, ?, ?, ?)");
	(s << row.job << row.strip << row.worker << row.when << row.line << row.log).run();
}

void clear_failures(Database& db, JobId job) {
	Statement s(db, "DELETE FROM failure WHERE job = ?");
	(s << job).run();
}

void set_aside(Database& db, const WorkerId& worker, const std::string& why, double now) {
	Statement s(db, "INSERT OR REPLACE INTO aside(worker, why, at) VALUES(?, ?, ?)");
	(s << worker << why << now).run();
}

void forget_aside(Database& db, double before) {
	Statement s(db, "DELETE FROM aside WHERE at < ?");
	(s << before).run();
}

void set_frame(Database& db, JobId job, int frame, bool stitched) {
	Statement s(db, stitched ? "INSERT OR IGNORE INTO frame(frame, job) SELECT ?, id FROM job WHERE id = ?"
							 : "DELETE FROM frame WHERE frame = ? AND job = ?");
	(s << frame << job).run();
}

} // namespace farm::rows
