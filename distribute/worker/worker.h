// SPDX-License-Identifier: AGPL-3.0-or-later
/// A worker: takes strips from a server, has povray render them, sends them in.
#ifndef FARM_WORKER_H
#define FARM_WORKER_H

#include "distribute/http/client.h"
#include "distribute/protocol/messages.h"
#include "distribute/worker/cache.h"
#include "distribute/worker/strip.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <set>

namespace farm {

struct WorkerSettings {
	Access_to server;
	std::string name;       ///< for people
	int slots = 1;          ///< strips at a time
	double idle_exit = 0;   ///< seconds without work after which it leaves; 0: stays
	double grace = 20;      ///< seconds that a strip may still take after SIGTERM
	bool when_idle = false; ///< takes nothing while others use more than half of the cores
	fs::path cache, scratch;
	Renderer renderer;
};

class Worker {
public:
	explicit Worker(const WorkerSettings& settings);
	/// Until it is told to stop or has been idle for long enough. Call once. Throws Refused or Error if the server turns it away.
	void run();
	/// Takes nothing new. Strips under way go on for `grace` seconds if `finish`, else they are given back at once. From any
	/// thread.
	void stop(bool finish);

private:
	using Clock = std::chrono::steady_clock;
	void serve_slot();
	void keep_touch();
	void hello(Client& client);
	/// A strip that is rendered and still has to be cut and sent.
	struct Finished;
	/// Null if there is nothing to send: it failed, was given back, or is not wanted any more.
	std::shared_ptr<Finished> work_on(Client& client, const Task& task);
	void deliver(Client& client, const Finished& finished);
	void fail(Client& client, const Task& task, Failure failure);
	/// It is this machine that cannot: the strip goes back, and blames nobody.
	void beg_off(Client& client, const Task& task, const std::string& why);
	/// One of the two, by whether there is room to write here.
	void fail_or_beg_off(Client& client, const Task& task, const fs::path& scratch, const Failure& failure);
	void let_go(std::int64_t lease);
	/// Asks until there is an answer, or the lease or all hope is lost.
	void insist(std::int64_t lease, const std::function<json()>& ask);
	bool lost(std::int64_t lease);
	void pause(double seconds);
	bool give_up_now();
	bool others_work();

	WorkerSettings settings;
	Hello self;
	Cache cache;
	std::atomic<bool> stopping = false, unwell = false;
	std::atomic<double> beat_every = 1;
	std::mutex mutex;
	std::condition_variable wake;
	std::set<std::int64_t> held, dropped;
	Clock::time_point deadline = Clock::time_point::max(), last_work = Clock::now();
	Clock::time_point told = Clock::now() - std::chrono::hours(1); ///< when it last said that it is unwell
	int busy = 0;
	std::string refusal; ///< why the server turned us away
	bool over = false;
};

} // namespace farm
#endif
