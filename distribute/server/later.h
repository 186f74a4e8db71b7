// SPDX-License-Identifier: AGPL-3.0-or-later
/// Coroutines that wait for other threads.
///
/// GCC 12 copies a lambda that is written within a co_await expression byte by byte, and what it captures with it: name it first,
/// then pass it.
#ifndef FARM_LATER_H
#define FARM_LATER_H

#include "distribute/http/message.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>

#include <chrono>
#include <exception>
#include <optional>

namespace farm {

/// Something that happens once. Waited for by a coroutine of the context; `ring` may be called from any thread. Lives in a
/// shared_ptr held by both.
class Bell : public std::enable_shared_from_this<Bell> {
public:
	explicit Bell(boost::asio::io_context& c) : context(c), timer(c) {
		timer.expires_at(std::chrono::steady_clock::time_point::max());
	}
	void ring() {
		boost::asio::post(context, [self = shared_from_this()] {
			self->rung = true;
			self->timer.cancel();
		});
	}
	/// False if `seconds` went by first.
	Awaitable<bool> wait(double seconds = 1e9) {
		if (!rung) {
			timer.expires_after(std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000)));
			boost::system::error_code ignored;
			co_await timer.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, ignored));
		}
		co_return rung;
	}

private:
	boost::asio::io_context& context;
	boost::asio::steady_timer timer;
	bool rung = false;
};

/// Runs a function in the pool and waits for what it returns or throws.
template <class F>
Awaitable<std::invoke_result_t<F>> in_pool(boost::asio::io_context& context, boost::asio::thread_pool& pool, F function) {
	using Result = std::invoke_result_t<F>;
	struct State {
		std::optional<std::conditional_t<std::is_void_v<Result>, int, Result>> result;
		std::exception_ptr error;
	};
	auto state = std::make_shared<State>();
	auto bell = std::make_shared<Bell>(context);
	boost::asio::post(pool, [state, bell, function = std::move(function)]() mutable {
		try {
			if constexpr (std::is_void_v<Result>) {
				function();
				state->result = 0;
			} else {
				state->result = function();
			}
		} catch (...) {
			state->error = std::current_exception();
		}
		bell->ring();
	});
	co_await bell->wait();
	if (state->error)
		std::rethrow_exception(state->error);
	if constexpr (!std::is_void_v<Result>)
		co_return std::move(*state->result);
}

} // namespace farm
#endif
