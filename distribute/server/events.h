// SPDX-License-Identifier: AGPL-3.0-or-later
/// What changes, told to whoever watches. It is gathered for a quarter of a second, and then what was touched is told as it
/// stands by then: however busy the farm, a watcher gets four pieces a second, and whoever takes them as they come knows what is
/// so.
#ifndef FARM_EVENTS_H
#define FARM_EVENTS_H

#include "distribute/schedule/types.h"
#include "distribute/server/later.h"

#include <nlohmann/json.hpp>

#include <deque>
#include <memory>
#include <set>
#include <string>

namespace farm {

/// What was touched since the last piece.
struct Touched {
	std::map<JobId, std::set<int>> strips; ///< also jobs without a strip
	std::set<WorkerId> workers;
	nlohmann::json failures = nlohmann::json::array();
};

class Events {
public:
	using Text = std::shared_ptr<const std::string>; ///< one for all watchers
	explicit Events(boost::asio::io_context& c) : context(c), timer(c) {}
	/// Says how what was touched is put into words; before the first watcher comes.
	void speak(std::function<nlohmann::json(const Touched&)> function) { compose = std::move(function); }

	void job(JobId id) {
		touch([&] { touched.strips[id]; });
	}
	void strip(JobId id, int strip, const WorkerId& worker = {}) {
		touch([&] {
			touched.strips[id].insert(strip);
			if (!worker.empty())
				touched.workers.insert(worker);
		});
	}
	void worker(const WorkerId& id) {
		touch([&] { touched.workers.insert(id); });
	}
	void failure(nlohmann::json what) {
		touch([&] { touched.failures.push_back(std::move(what)); });
	}

	/// One watcher's queue.
	class Watch {
	public:
		explicit Watch(Events& e) : events(e) { events.watches.insert(this); }
		~Watch() { events.watches.erase(this); }
		Watch(const Watch&) = delete;
		/// The next piece; null after `seconds` without any.
		Awaitable<Text> next(double seconds) {
			if (queue.empty()) {
				bell = std::make_shared<Bell>(events.context);
				co_await bell->wait(seconds);
				bell.reset();
			}
			if (queue.empty())
				co_return nullptr;
			Text text = std::move(queue.front());
			queue.pop_front();
			co_return text;
		}
		/// Whether it was too slow for what there was to tell: it must be told everything anew. Asking forgets it.
		bool missed() { return std::exchange(late, false); }

	private:
		friend class Events;
		Events& events;
		std::deque<Text> queue;
		std::shared_ptr<Bell> bell;
		bool late = false;
	};

private:
	/// Seconds between two pieces, and how many may wait for a slow watcher.
	static constexpr double pace = 0.25;
	static constexpr size_t most = 40;

	template <class Touch> void touch(Touch how) {
		if (watches.empty())
			return;
		how();
		if (std::exchange(waiting, true))
			return;
		timer.expires_after(std::chrono::milliseconds(static_cast<int>(1000 * pace)));
		timer.async_wait([this](const boost::system::error_code& error) {
			if (!error)
				tell();
		});
	}

	void tell() {
		waiting = false;
		const Touched all = std::exchange(touched, {});
		if (watches.empty())
			return;
		const auto text =
			std::make_shared<const std::string>(compose(all).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
		for (Watch* w : watches) {
			if (w->queue.size() >= most) {
				w->queue.clear();
				w->late = true;
			}
			w->queue.push_back(text);
			if (w->bell)
				w->bell->ring();
		}
	}

	boost::asio::io_context& context;
	boost::asio::steady_timer timer;
	std::function<nlohmann::json(const Touched&)> compose;
	Touched touched;
	bool waiting = false;
	std::set<Watch*> watches;
};

} // namespace farm
#endif
