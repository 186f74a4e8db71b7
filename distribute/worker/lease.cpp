// SPDX-License-Identifier: AGPL-3.0-or-later
// A lease, from the strip it is for to the answer that ends it.
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/stitch/picture.h"
#include "distribute/worker/backoff.h"
#include "distribute/worker/finished.h"

#include <nlohmann/json.hpp>

#include <thread>

namespace farm {

void Worker::let_go(std::int64_t lease) {
	const std::lock_guard lock(mutex);
	held.erase(lease);
	dropped.erase(lease);
	--busy;
	last_work = Clock::now();
}

void Worker::insist(std::int64_t lease, const std::function<json()>& ask) {
	Backoff backoff;
	std::string said;
	for (int refused = 0; !lost(lease);) {
		try {
			ask();
			return;
		} catch (const Refused& e) {
			if (said != e.what())
				say("lease " + std::to_string(lease) + ": " + e.what());
			said = e.what();
			// What the server cannot do now it may do later; what it will not do once more is not worth a third time.
			if (e.status < 500 && e.status != 401 && ++refused > 5)
				return;
		} catch (const Unreachable&) {
		}
		// Stopping too waits for an answer, within its grace.
		if (give_up_now())
			return;
		std::this_thread::sleep_for(std::chrono::duration<double>(backoff.next()));
	}
}

std::shared_ptr<Worker::Finished> Worker::work_on(Client& client, const Task& task) {
	const std::string back = "/v1/leases/" + std::to_string(task.lease) + "/return";
	try {
		auto finished = std::make_shared<Finished>(task, settings.scratch);
		fs::path root, folder;
		insist(task.lease, [&] {
			folder = cache.bundle(client, task.spec.bundle, root);
			return json();
		});
		if (folder.empty())
			throw Error("the scene's files could not be fetched");
		const fs::path inside = finished->scratch.path() / "render";
		fs::create_directory(inside);
		Rendered& done = finished->rendered;
		done = render_strip(
			settings.renderer, task, root, folder, inside, [&] { return lost(task.lease) || (stopping && give_up_now()); });
		if (done.given_up && lost(task.lease))
			return nullptr; // somebody else has done it
		if (done.given_up || done.not_started) {
			if (done.not_started)
				pause(1);
			insist(task.lease, [&] { return client.post(back, json::object()); });
			return nullptr;
		}
		if (!done.picture.empty()) {
			unwell = false;
			return finished;
		}
		fail_or_beg_off(client, task, finished->scratch.path(), done.failure);
	} catch (const Error& e) {
		if (e.number)
			beg_off(client, task, e.what());
		else
			fail(client, task, {e.what(), ""});
	} catch (const fs::filesystem_error& e) {
		beg_off(client, task, e.what());
	} catch (const std::exception& e) {
		fail(client, task, {e.what(), ""});
	}
	return nullptr;
}

void Worker::deliver(Client& client, const Finished& f) {
	try {
		const Task& task = f.task;
		const bool frame = task.rows == task.spec.height;
		const fs::path strip = frame ? f.rendered.picture : f.scratch.path() / ("strip" + task.spec.suffix());
		if (!frame)
			cut(task.spec.format, f.rendered.picture, task.row, task.rows, strip);
		const std::string to = "/v1/leases/" + std::to_string(task.lease) + "/strip?sha256=" + sha256_file(strip) +
							   "&seconds=" + std::to_string(f.rendered.seconds);
		insist(task.lease, [&] { return client.put_file(to, strip); });
	} catch (const std::exception& e) {
		fail_or_beg_off(client, f.task, f.scratch.path(), {e.what(), ""});
	}
}

void Worker::fail_or_beg_off(Client& client, const Task& task, const fs::path& scratch, const Failure& failure) {
	try { // for want of room any povray fails, and may say anything
		write_durably(scratch / "room", std::string(1 << 16, 'x'));
	} catch (const Error& e) {
		beg_off(client, task, e.what());
		return;
	}
	fail(client, task, failure);
}

void Worker::beg_off(Client& client, const Task& task, const std::string& why) {
	unwell = true;
	bool tell = false;
	{
		const std::lock_guard lock(mutex);
		tell = Clock::now() - told > std::chrono::minutes(1);
		told = tell ? Clock::now() : told;
	}
	if (tell)
		say(why + "; strips go back until that is mended");
	insist(task.lease, [&] { return client.post("/v1/leases/" + std::to_string(task.lease) + "/return", json::object()); });
}

void Worker::fail(Client& client, const Task& task, Failure failure) {
	constexpr size_t most = 1900;
	if (failure.line.size() > most)
		failure.line.erase(0, failure.line.size() - most);
	say("job " + std::to_string(task.job) + ", frame " + std::to_string(task.frame) + ": " + failure.line);
	insist(task.lease, [&] { return client.post("/v1/leases/" + std::to_string(task.lease) + "/failure", failure); });
}

} // namespace farm
