// SPDX-License-Identifier: AGPL-3.0-or-later
/// The scheduler's nouns.
#ifndef FARM_SCHEDULE_TYPES_H
#define FARM_SCHEDULE_TYPES_H

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace farm {

using Time = double; ///< seconds on a clock that never goes back
using JobId = std::int64_t;
using LeaseId = std::int64_t;
using WorkerId = std::string;
using PixelHash = std::uint64_t; ///< the first 64 bits of the SHA-256 of a strip's pixels

/// The numbers behind the rules.
struct Rules {
	double lease = 20;            ///< seconds without a heartbeat after which a worker's leases end
	int tries = 3;                ///< failures after which a strip is given up
	int losses = 20;              ///< leases that ended in silence, after which likewise
	int blame = 2;                ///< strips that failed here and were rendered elsewhere, after which a worker is set aside
	double straggler = 2;         ///< a strip goes out twice when it takes this many times the job's mean,
	double straggler_least = 2;   ///< and at least so many seconds;
	double straggler_first = 120; ///< or so many where nothing is done yet
	int check_every = 32;         ///< one in so many strips, and a worker's first of each job, is rendered by two; 0: none
	double check_patience = 30;   ///< seconds to wait for a second worker, where there is none
	double absent = 60;           ///< seconds without asking for work after which an idle worker's opinion is not waited for
	int doubts = 3;               ///< times that one of a worker's strips is opened again to check its word, a job
	int lease_gap = 1;            ///< leases' ids go up by 1 to so many, at random, so that nobody hits another's by mistake
	double rest = 1;              ///< seconds a worker rests after its second failure in a row; doubles each time, to a minute
};

struct Lease {
	LeaseId id = 0;
	JobId job = 0;
	int strip = 0;
	WorkerId worker;
	Time started = 0, expires = 0;
};

struct StripRef {
	JobId job;
	int strip;
};

enum class Stage { running, paused, done, failed, cancelled };
enum class StripState : std::uint8_t { waiting, out, settled, given_up };

struct Vote {
	WorkerId worker;
	PixelHash hash;
	bool settled = false; ///< of those restored: whether it had settled its strip
};

/// What is known of a strip beyond its state; only strips with something to tell have one.
struct Trouble {
	std::set<WorkerId> failed_by, returned_by;
	std::set<WorkerId> limited; ///< those of failed_by that only met a limit of their own
	int failures = 0, losses = 0;
	std::vector<Vote> votes; ///< while more than one is needed
	int needed = 1;          ///< votes for one hash
	Time since = -1;         ///< waits for a second worker since then; negative: does not
};

struct Settled {
	PixelHash hash = 0;
	int worker = -1; ///< index in JobState::names; -1: two or more agreed
};

struct JobState {
	JobId id = 0;
	int strips = 0, priority = 0;
	Stage stage = Stage::running;
	int settled = 0;        ///< how many
	int next = 0;           ///< strips from here on were never lent
	std::set<int> returned; ///< strips below `next` that wait
	std::vector<StripState> state;
	std::vector<Settled> result;
	std::unordered_map<int, Trouble> trouble;
	std::unordered_map<int, std::vector<LeaseId>> out;
	std::map<WorkerId, int> names;  ///< workers that answered, numbered
	std::set<WorkerId> confirmed;   ///< those of them with whom another has agreed
	std::map<WorkerId, int> asked;  ///< of those with whom none has yet, the strip that another is asked about
	std::map<WorkerId, int> doubts; ///< how often one of its settled strips was opened again for that
	int given_up = -1;              ///< the strip that failed the job
	double seconds = 0;             ///< what settled strips took, in all
	int timed = 0;                  ///< how many those are

	int waiting() const { return strips - next + static_cast<int>(returned.size()); }
};

struct WorkerState {
	int slots = 1;
	Time heard = 0; ///< last heartbeat
	Time asks = 0;  ///< when it last asked for work
	std::set<LeaseId> leases;
	std::string aside; ///< why it gets no work; empty: it does
	bool draining = false;
	int blame = 0;
	int failures = 0; ///< in a row
	Time rests_until = 0;
	std::int64_t done = 0; ///< strips
};

/// What a call brought about besides what it was asked for.
struct Changes {
	std::vector<Lease> ended; ///< leases taken away: expired, or no longer needed
	std::vector<StripRef> settled;
	std::vector<StripRef> reopened;
	std::vector<StripRef> given_up;            ///< the job failed of this
	std::map<JobId, std::set<WorkerId>> split; ///< of those, where the answers differed: whose
	std::vector<JobId> done;
	std::vector<std::pair<WorkerId, std::string>> aside; ///< and why
	std::vector<WorkerId> gone;                          ///< not heard of for a lease's time
};

} // namespace farm
#endif
