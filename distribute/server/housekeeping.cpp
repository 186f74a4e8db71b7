// SPDX-License-Identifier: AGPL-3.0-or-later
// The spool cleans itself: old jobs go, and with the last job that needs them, bundles and files.
#include "distribute/common/error.h"
#include "distribute/server/farm.h"

#include <algorithm>

namespace farm {
namespace {

constexpr double day = 86400;
/// What was sent ahead of its job may wait for it so long.
constexpr double patience = day;

} // namespace

// It may be gone meanwhile, or the disk too full even for that: the next round tries again.
Awaitable<void> Farm::remove_old(JobId id) {
	try {
		co_await remove(id);
	} catch (const std::exception& e) {
		say(std::string("while cleaning the spool: ") + e.what());
	}
}

Awaitable<void> Farm::keep_house() {
	while (true) {
		std::vector<const Job*> ended;
		std::set<std::string> bundles;
		for (const auto& [id, job] : all_jobs)
			if (job.row.ended > 0)
				ended.push_back(&job);
		std::sort(ended.begin(), ended.end(), [](const Job* a, const Job* b) { return a->row.ended < b->row.ended; });
		std::vector<JobId> old, others;
		for (const Job* job : ended)
			(wall_time() - job->row.ended > settings.keep_days * day ? old : others).push_back(job->row.id);
		for (const JobId id : old) {
			say("job " + std::to_string(id) + " is removed: it ended " + std::to_string(static_cast<int>(settings.keep_days)) +
				" days ago");
			co_await remove_old(id);
		}
		auto measure = [this] { return spool.bytes(); };
		for (const JobId id : others) {
			if (settings.keep_bytes <= 0 || static_cast<double>(co_await in_pool(context, pool, measure)) <= settings.keep_bytes)
				break;
			say("job " + std::to_string(id) + " is removed: the spool is larger than it may be");
			co_await remove_old(id);
		}
		note([before = wall_time() - settings.keep_days * day](Database& db) { rows::forget_aside(db, before); });
		for (const auto& [id, job] : all_jobs)
			bundles.insert(job.row.spec.bundle);
		auto sweep = [this, bundles] { spool.sweep(bundles, patience); };
		try {
			co_await in_pool(context, pool, sweep);
		} catch (const std::exception& e) {
			say(std::string("while cleaning the spool: ") + e.what());
		}
		auto rest = std::make_shared<Bell>(context);
		co_await rest->wait(600);
	}
}

} // namespace farm
