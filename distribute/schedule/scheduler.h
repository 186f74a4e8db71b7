// SPDX-License-Identifier: AGPL-3.0-or-later
/// Which worker renders which strip, and what to make of the answers. Does no input or output and knows no clock: each call is
/// told the time.
///
/// A strip is lent by a lease with an id that is never used again (fencing): a lease that has ended changes nothing any more. A
/// strip is settled by a vote: the hash of its pixels from one worker, or, for spot checks, the same from two. Votes that differ
/// ask for further workers until two agree; who differed from them is set aside, and whatever rests on that worker's word alone
/// is opened again.
///
/// Not thread-safe. Unless said otherwise, a call for a job, worker or lease that is not known does nothing.
#ifndef FARM_SCHEDULER_H
#define FARM_SCHEDULER_H

#include "distribute/schedule/types.h"

#include <map>
#include <optional>
#include <random>
#include <set>
#include <unordered_map>
#include <vector>

namespace farm {

class Scheduler {
public:
	/// Leases are numbered from `first_lease` on; it must be above any given out before.
	Scheduler(const Rules& rules, LeaseId first_lease);

	/// A job of so many strips, numbered from 0 in the order in which they are to be lent.
	void add_job(JobId job, int strips, int priority);
	void forget_job(JobId job, Changes& changes);
	/// Running, paused, cancelled; a job that failed or is done stays so, except that `retry` makes a failed one run again.
	void set_paused(JobId job, bool paused);
	void cancel(JobId job, Changes& changes);
	void retry(JobId job);

	/// Said again after a loss of touch; a worker that was set aside stays so unless `pardon`.
	void add_worker(const WorkerId& worker, int slots, Time now, bool pardon = true);
	/// Its leases end without blame.
	void remove_worker(const WorkerId& worker, Changes& changes);
	/// A worker that drains gets nothing new.
	void drain(const WorkerId& worker, bool draining);

	/// The next strip for this worker, if there is one.
	std::optional<Lease> take(const WorkerId& worker, Time now);
	/// The worker is alive and works on these leases; those returned have ended and are to be dropped.
	std::vector<LeaseId> beat(const WorkerId& worker, const std::vector<LeaseId>& leases, Time now);
	/// The worker's answer. False if the lease has ended: then nothing changes.
	bool complete(LeaseId lease, PixelHash hash, Time now, Changes& changes);
	/// The worker could not; it is not blamed for that if a limit of its own was in the way. False likewise.
	bool fail(LeaseId lease, Time now, Changes& changes, bool limited = false);
	/// The worker will not, through no fault of the strip. False likewise.
	bool give_back(LeaseId lease);
	/// Ends leases that have not been heard of in time; to be called every second or so.
	void tick(Time now, Changes& changes);

	/// What was known before a restart: first the jobs and who was set aside, then each job's votes by strip and in their order,
	/// then leases that were out (they get a fresh term). Votes are counted anew: what they decided may not have been written
	/// down.
	void restore_aside(const WorkerId& worker, const std::string& why) { banned[worker] = why; }
	void restore_votes(JobId job, const std::map<int, std::vector<Vote>>& votes, Changes& changes);
	void restore_lease(const Lease& lease, Time now);
	void restore_failed(JobId job);

	const std::map<JobId, JobState>& jobs() const { return job_states; }
	const std::map<WorkerId, WorkerState>& workers() const { return worker_states; }
	const std::map<LeaseId, Lease>& leases() const { return lease_states; }
	const Lease* lease(LeaseId id) const;
	/// Whether `take` may have something for somebody: how many strips wait to be lent.
	int waiting() const;
	/// What the strip stands at, for showing.
	StripState state(JobId job, int strip) const;

private:
	JobState* job(JobId id);
	WorkerState* worker(const WorkerId& id);
	bool may_take(const JobState& job, int strip, const WorkerId& worker, Time now) const;
	std::optional<int> first_waiting(JobState& job, const WorkerId& worker, Time now);
	std::optional<StripRef> straggler(const WorkerId& worker, Time now);
	Lease lend(JobState& job, int strip, const WorkerId& worker, Time now);
	void end_lease(LeaseId id);
	void end_leases_of(JobState& job, int strip, Changes& changes);
	void release(JobState& job, int strip);
	void vote(JobState& job, int strip, const WorkerId& worker, PixelHash hash, Time now, Changes& changes);
	void settle(JobState& job, int strip, const WorkerId& worker, PixelHash hash, Time now, Changes& changes);
	void reopen(JobState& job, int strip, Changes& changes);
	/// Asks another about a strip of each worker whose word nobody has confirmed, or only of those that have gone.
	void doubt(JobState& job, bool only_gone, Time now, Changes& changes);
	void ask_another(JobState& job, int strip, const WorkerId& about);
	void set_aside(const WorkerId& worker, const std::string& why, Changes& changes);
	bool wants_second(const JobState& job, int strip, const WorkerId& worker) const;
	bool somebody_else(const JobState& job, int strip, Time now, const WorkerId& than = {}) const;
	void give_up(JobState& job, int strip, Changes& changes);
	void update_ready(JobState& job);
	void check_done(JobState& job, Time now, Changes& changes);

	Rules rules;
	LeaseId next_lease;
	std::minstd_rand chance{std::random_device()()};
	std::map<WorkerId, std::string> banned; // set aside, and why; also those that are not here
	std::map<JobId, JobState> job_states;
	std::map<WorkerId, WorkerState> worker_states;
	std::map<LeaseId, Lease> lease_states; // by id, so by age
	std::set<LeaseId> alone;               // leases whose strip is lent once
	std::set<std::pair<int, JobId>> ready; // (-priority, id) of running jobs with waiting strips
};

} // namespace farm
#endif
