// SPDX-License-Identifier: AGPL-3.0-or-later
/// What happens, told to whoever watches. A watcher that does not keep up loses the oldest news and is told so.
#ifndef FARM_EVENTS_H
#define FARM_EVENTS_H

#include "distribute/server/later.h"

#include <nlohmann/json.hpp>

#include <deque>
#include <memory>
#include <set>
#include <string>

namespace farm {

class Events {
public:
	explicit Events(boost::asio::io_context& c) : context(c) {}

	/// One watcher's queue.
	class Watch {
	public:
		Watch(Events& e) : events(e) { events.watches.insert(this); }
		~Watch() { events.watches.erase(this); }
		Watch(const Watch&) = delete;
		/// The next piece of news as JSON text; empty after `seconds` without any.
		Awaitable<std::string> next(double seconds) {
			if (queue.empty()) {
				bell = std::make_shared<Bell>(events.context);
				co_await bell->wait(seconds);
				bell.reset();
			}
			if (queue.empty())
				co_return "";
			std::string text = std::move(queue.front());
			queue.pop_front();
			co_return text;
		}

	private:
		friend class Events;
		Events& events;
		std::deque<std::string> queue;
		std::shared_ptr<Bell> bell;
	};

	void tell(const nlohmann::json& news) {
		if (watches.empty())
			return;
		const std::string text = news.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
		for (Watch* w : watches) {
			if (w->queue.size() >= most) {
				w->queue.clear();
				w->queue.push_back(R"({"event":"missed"})");
			}
			w->queue.push_back(text);
			if (w->bell)
				w->bell->ring();
		}
	}

private:
	static constexpr size_t most = 10000;
	boost::asio::io_context& context;
	std::set<Watch*> watches;
};

} // namespace farm
#endif
