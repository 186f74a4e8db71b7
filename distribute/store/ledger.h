// SPDX-License-Identifier: AGPL-3.0-or-later
/// The ledger: what the server must not forget. One SQLite file in the spool.
///
/// Rows are written by functions queued to a thread of the ledger's own, which runs all that have come together in one
/// transaction; whoever queued one is told when that transaction is on the disk. So the caller never waits for the disk, and a
/// hundred reports cost one fsync.
#ifndef FARM_LEDGER_H
#define FARM_LEDGER_H

#include "distribute/protocol/messages.h"
#include "distribute/schedule/types.h"
#include "distribute/store/database.h"

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace farm {

/// A job as it stands in the ledger.
struct JobRow {
	JobId id = 0;
	JobSpec spec;
	Stage stage = Stage::running;
	std::string error;  ///< why it failed
	double created = 0; ///< seconds since 1970
	double ended = 0;   ///< likewise; 0: has not
};

/// A strip's picture from one worker.
struct ReportRow {
	JobId job = 0;
	int strip = 0;
	WorkerId worker;
	std::string pixels; ///< SHA-256 of the decoded pixels
	double seconds = 0; ///< the worker's own time for it
	bool settled = false;
};

struct FailureRow {
	JobId job = 0;
	int strip = 0;
	WorkerId worker;
	double when = 0; ///< seconds since 1970
	std::string line, log;
};

class Ledger {
public:
	/// Opens or makes the file; throws Error if it is damaged or of another version.
	explicit Ledger(const std::filesystem::path& file);
	~Ledger();

	using Work = std::function<void(Database&)>;
	using Done = std::function<void(const std::string& error)>;
	/// Queues work; `done` is called from the ledger's thread, with an empty string once it is on the disk. Work that throws is
	/// undone by itself and does not hurt what else is in the transaction. Work and done may not call the ledger.
	void post(Work work, Done done);
	/// Likewise, but waits. For start and stop; throws Error.
	void write(const Work& work);

	// To be called before the first `post`, that is at start.
	std::vector<JobRow> jobs();
	std::vector<ReportRow> reports(JobId job);
	std::vector<Lease> leases();
	std::vector<std::pair<JobId, int>> frames();           ///< those stitched
	std::vector<std::pair<WorkerId, std::string>> aside(); ///< workers set aside, and why
	/// A number above any lease's id so far.
	LeaseId next_lease();

	/// Reads that may be asked for at any time, from any thread: they use a connection of their own.
	std::vector<FailureRow> failures(JobId job);
	std::string damage();

private:
	struct Entry {
		Work work;
		Done done;
	};
	void serve();

	std::filesystem::path file;
	Database database;
	std::unique_ptr<Database> reading;
	std::mutex reading_mutex;
	std::mutex mutex;
	std::condition_variable wake;
	std::vector<Entry> queue;
	bool ending = false;
	std::thread thread;
};

/// The rows' own statements, for use in Work.
namespace rows {
JobId add_job(Database& db, const JobSpec& spec, double now); ///< or the id of the one with the same client_key
void set_stage(Database& db, JobId job, Stage stage, const std::string& error, double now);
void remove_job(Database& db, JobId job);
void add_lease(Database& db, const Lease& lease);
/// False if it had ended before: whatever was to be done under it must not be.
bool end_lease(Database& db, LeaseId lease);
void end_leases(Database& db, JobId job);
void add_report(Database& db, const ReportRow& row);
/// Those reports of the strip whose pixels' hash starts with these 16 digits; none of them if `pixels` is empty.
void set_settled(Database& db, JobId job, int strip, const std::string& pixels);
void add_failure(Database& db, const FailureRow& row);
void clear_failures(Database& db, JobId job);
void set_aside(Database& db, const WorkerId& worker, const std::string& why, double now);
void forget_aside(Database& db, double before); ///< those set aside before then
void set_frame(Database& db, JobId job, int frame, bool stitched);
} // namespace rows

} // namespace farm
#endif
