// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/worker/worker.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/render/povray.h"
#include "distribute/render/probe.h"
#include "distribute/worker/backoff.h"
#include "distribute/worker/finished.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <future>
#include <thread>

namespace farm {
Worker::Worker(const WorkerSettings& s) : settings(s), cache(s.cache) {
	self.id = random_hex(16);
	self.name = settings.name;
	self.slots = settings.slots;
	self.povray = povray_version(settings.renderer.povray, settings.renderer.sandbox);
	self.probe = probe(settings.renderer.povray, settings.renderer.sandbox);
	std::srand(static_cast<unsigned>(std::stoul(self.id.substr(0, 7), nullptr, 16)));
}

void Worker::pause(double seconds) {
	std::unique_lock lock(mutex);
	wake.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return over || stopping; });
}

void Worker::stop(bool finish) {
	{
		const std::lock_guard lock(mutex);
		stopping = true;
		deadline =
			std::min(deadline, Clock::now() + std::chrono::milliseconds(finish ? static_cast<long>(1000 * settings.grace) : 0));
	}
	wake.notify_all();
}

bool Worker::give_up_now() {
	const std::lock_guard lock(mutex);
	return Clock::now() >= deadline;
}

bool Worker::others_work() {
	double load = 0;
	const std::lock_guard lock(mutex);
	return ::getloadavg(&load, 1) == 1 && load - busy > 0.5 * std::thread::hardware_concurrency();
}

bool Worker::lost(std::int64_t lease) {
	const std::lock_guard lock(mutex);
	return dropped.count(lease) > 0;
}

void Worker::hello(Client& client) {
	try {
		const json answer = client.post("/v1/workers", self);
		beat_every = std::clamp(answer.value("lease_seconds", 20.0) / 4, 0.2, 30.0);
	} catch (const Refused& e) {
		if (e.status == 409) { // turned away
			{
				const std::lock_guard lock(mutex);
				refusal = e.what();
			}
			stop(false);
		}
		throw;
	}
}

void Worker::run() {
	Client client(settings.server);
	client.stop_when(&stopping);
	Backoff backoff;
	for (bool said = false; !stopping;) {
		try {
			hello(client);
			say("at work for " + settings.server.url + " as " + self.name + ", " + std::to_string(self.slots) +
				(self.slots == 1 ? " slot" : " slots"));
			break;
		} catch (const Distrusted&) {
			throw;
		} catch (const Unreachable& e) {
			if (!said)
				say(std::string(e.what()) + "; trying on");
			said = true;
			pause(backoff.next());
		}
	}
	std::thread touch([this] { keep_touch(); });
	std::vector<std::thread> slots;
	for (int i = 0; i < settings.slots; ++i)
		slots.emplace_back([this] { serve_slot(); });
	for (auto& slot : slots)
		slot.join();
	{
		const std::lock_guard lock(mutex);
		over = true;
	}
	wake.notify_all();
	touch.join();
	try {
		Client(settings.server).remove("/v1/workers/" + self.id);
	} catch (const Error&) { // its leases run out by themselves
	}
	if (!refusal.empty())
		throw Error(refusal);
}

void Worker::keep_touch() {
	Client client(settings.server);
	while (true) {
		std::vector<std::int64_t> leases;
		{
			std::unique_lock lock(mutex);
			wake.wait_for(lock, std::chrono::duration<double>(beat_every.load()), [this] { return over; });
			if (over)
				return;
			leases.assign(held.begin(), held.end());
		}
		try {
			const json answer = client.post("/v1/workers/" + self.id + "/heartbeat", {{"leases", leases}});
			const std::lock_guard lock(mutex);
			for (const auto& lease : answer.at("drop"))
				if (held.count(lease.get<std::int64_t>()))
					dropped.insert(lease.get<std::int64_t>());
			if (answer.value("draining", false) && !stopping) {
				say("told to leave; finishing");
				stopping = true;
			}
		} catch (const Refused& e) {
			if (e.status != 404)
				say(e.what());
			else // the server has forgotten us; what we hold it may still know
				try {
					hello(client);
				} catch (const Error&) {
				}
		} catch (const std::exception&) { // the next one will do
		}
	}
}

void Worker::serve_slot() {
	Client client(settings.server);
	client.stop_when(&stopping);
	Client sending(settings.server), delivering(settings.server); // go on while stopping
	Backoff backoff, hurt;
	std::future<void> delivery; // of the strip before: it is cut and sent while the next is rendered
	while (!stopping) {
		if (unwell)
			pause(hurt.next());
		else
			hurt.reset();
		if (settings.when_idle && others_work()) {
			pause(5);
			continue;
		}
		try {
			const double wait = settings.idle_exit > 0 ? std::min(30.0, settings.idle_exit) : 30.0;
			const json answer = client.post("/v1/workers/" + self.id + "/take", {{"wait", wait}}, wait);
			backoff.reset();
			if (answer.is_null()) {
				const std::lock_guard lock(mutex);
				const bool idle = busy == 0 && settings.idle_exit > 0;
				if (idle && Clock::now() - last_work > std::chrono::duration<double>(settings.idle_exit))
					stopping = true;
				continue;
			}
			const Task task = answer.get<Task>();
			{
				const std::lock_guard lock(mutex);
				held.insert(task.lease);
				++busy;
			}
			const auto finished = work_on(sending, task);
			if (delivery.valid())
				delivery.get();
			if (!finished) {
				let_go(task.lease);
				continue;
			}
			delivery = std::async(std::launch::async, [this, &delivering, finished] {
				deliver(delivering, *finished);
				let_go(finished->task.lease);
			});
		} catch (const Refused& e) {
			if (e.status == 404) {
				try {
					hello(client);
					continue;
				} catch (const Error&) {
				}
			} else {
				say(e.what());
			}
			pause(backoff.next());
		} catch (const std::exception&) {
			pause(backoff.next());
		}
	}
}

} // namespace farm
