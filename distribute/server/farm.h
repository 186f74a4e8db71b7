// SPDX-License-Identifier: AGPL-3.0-or-later
/// The farm as a whole: the scheduler's decisions, the ledger's memory and the spool's files held together. One thread;
/// coroutines wait for the disk.
///
/// The order that keeps the promise: a file is on the disk before its row, a row is committed before the scheduler knows, and the
/// scheduler knows before the answer goes out. Whoever got no answer asks again; asking again does no harm.
#ifndef FARM_FARM_H
#define FARM_FARM_H

#include "distribute/http/message.h"
#include "distribute/schedule/scheduler.h"
#include "distribute/server/events.h"
#include "distribute/server/later.h"
#include "distribute/store/ledger.h"
#include "distribute/store/mover.h"
#include "distribute/store/spool.h"

#include <deque>

namespace farm {

struct FarmSettings {
	fs::path spool;
	Rules rules;
	int threads = 2;       ///< for checking strips and stitching frames
	double keep_days = 30; ///< jobs that have ended are removed after so many
	double keep_bytes = 0; ///< and the oldest of them while the spool is larger; 0: whatever it is
};

/// A job as the farm has it.
struct Job {
	JobRow row;
	std::vector<bool> stitched; ///< by index of frame
	int frames_done = 0;
	std::string kind;  ///< of the first strip that came; others are refused, for they could not be joined
	std::string doing; ///< what keeps a job from its end, once all strips are there
};

/// A worker as it presented itself.
struct Guest {
	Hello hello;
	std::string from; ///< address
	double since = 0; ///< seconds since 1970
};

class Farm {
public:
	/// Takes up where the spool left off. Throws Error for a spool in use, damaged, or not writable.
	Farm(boost::asio::io_context& context, const FarmSettings& settings);
	~Farm();

	Awaitable<JobId> submit(JobSpec spec);
	/// Throw HttpError 404 where there is no such job, 409 where it is in no state for that.
	Awaitable<void> pause(JobId job, bool paused);
	Awaitable<void> cancel(JobId job);
	Awaitable<void> retry(JobId job);
	Awaitable<void> remove(JobId job);

	/// Throws HttpError 409 with the reason if the worker is turned away.
	void welcome(const Hello& hello, const std::string& from);
	Awaitable<void> leave(WorkerId worker);
	void drain(const WorkerId& worker, bool draining);
	/// A strip for the worker, within `wait` seconds. Throws HttpError 404 if the worker has not said hello to this server.
	/// Nothing is lent to a peer that has gone meanwhile.
	Awaitable<std::optional<Task>> take(WorkerId worker, double wait, std::shared_ptr<Peer> peer);
	/// Those of the leases that are to be dropped. 404 likewise.
	std::vector<LeaseId> beat(const WorkerId& worker, const std::vector<LeaseId>& leases);
	/// A strip's picture. Empty: taken; else why not: its lease has ended, and nothing changes, or it is no good, and counts as a
	/// failure. Throws HttpError 422 if the file is not what `sha256` says.
	Awaitable<std::string> report(LeaseId lease, fs::path file, std::string sha256, double seconds);
	Awaitable<std::string> failed(LeaseId lease, Failure failure);
	Awaitable<std::string> give_back(LeaseId lease);

	const std::map<JobId, Job>& jobs() const { return all_jobs; }
	const Job& job(JobId id) const;
	const std::map<WorkerId, Guest>& guests() const { return all_guests; }
	const Scheduler& schedule() const { return scheduler; }
	/// A strip's picture, if it is settled and its job not over.
	std::optional<fs::path> settled_strip(JobId job, int strip) const;
	/// Seconds until the job is done, by what its strips took so far; negative: cannot be told.
	double eta(JobId job) const;
	Ledger& book() { return ledger; }
	Spool& files() { return spool; }
	Events& news() { return events; }
	boost::asio::thread_pool& threads() { return pool; }
	boost::asio::io_context& io() { return context; }
	Time now() const;
	/// What keeps the spool from being written; empty: nothing does.
	void complain(const std::string& what);
	/// What keeps a job from its end or from going on: a clause, or nothing.
	std::string doing(const Job& job) const;
	const Rules& rules() const { return settings.rules; }

private:
	// restore.cpp
	void restore();
	using SettledAs = std::map<int, PixelHash>; ///< strips, by what the ledger has them settled as
	SettledAs restore_strips(const JobRow& row, Changes& changes);
	bool stitched_as(const Job& job, int index, const SettledAs& settled) const;
	/// Waits until it is on the disk; throws HttpError 507 if it cannot be.
	Awaitable<void> commit(Ledger::Work work);
	/// Likewise for a file that is written and has to get to its place.
	Awaitable<void> move(fs::path from, fs::path to);
	/// Does not wait: for what may be lost.
	void note(Ledger::Work work);
	void wake(int how_many);
	Awaitable<void> keep_house();
	Awaitable<void> remove_old(JobId job);
	void enter(const JobRow& row);
	void set_stage(Job& job, Stage stage, const std::string& error = "");
	Awaitable<void> tick();
	// changes.cpp
	void apply(const Changes& changes);
	/// What people call the worker: its name or, once it has gone, its id.
	const std::string& name_of(const WorkerId& worker) const;
	std::string place(const JobSpec& spec, int strip) const;
	// assembly.cpp
	void strip_settled(JobId job, int strip);
	Awaitable<void> assemble();
	Awaitable<void> stitch_frame(JobId job, int index);
	Awaitable<void> finish(JobId job);
	fs::path settled_file(const Job& job, int strip) const;
	std::vector<fs::path> strip_files(const Job& job, int index) const;
	bool frame_complete(const Job& job, int index) const;

	boost::asio::io_context& context;
	FarmSettings settings;
	Spool spool;
	Ledger ledger;
	Scheduler scheduler;
	Events events;
	boost::asio::thread_pool pool;
	Mover mover;
	std::map<JobId, Job> all_jobs;
	std::map<WorkerId, Guest> all_guests;
	std::deque<std::shared_ptr<Bell>> sleepers;  // long polls, the longest waiting first
	std::deque<std::pair<JobId, int>> to_stitch; // frame index; -1: finish the job
	std::shared_ptr<Bell> stitch_bell;
	std::string complaint;
	bool notes_lost = false; ///< what `note` was to write, to a full disk
};

/// How `doing` tells of an obstacle that somebody has to clear.
inline std::string waits_because(const std::string& obstacle) { return "waiting: " + obstacle; }
/// Seconds since 1970.
double wall_time();
const char* stage_name(Stage stage);

} // namespace farm
#endif
