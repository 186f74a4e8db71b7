// SPDX-License-Identifier: AGPL-3.0-or-later
/// One request and its answer, free of the library that carries them.
#ifndef FARM_HTTP_MESSAGE_H
#define FARM_HTTP_MESSAGE_H

#include <utility> // Boost 1.74's awaitable.hpp needs it

#include <boost/asio/awaitable.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace farm {

template <class T> using Awaitable = boost::asio::awaitable<T>;

/// Tells a handler that waits that nobody waits for it any more.
struct Peer {
	bool gone = false;
	std::function<void()> tell; ///< called once when it goes, if set
};

struct Request {
	std::string method;
	std::string path;                           ///< without the query
	std::vector<std::string> parts;             ///< what stood where the route has a '*'
	std::map<std::string, std::string> query;   ///< decoded
	std::map<std::string, std::string> headers; ///< names in lower case
	std::string body;                           ///< empty if it went to a file
	std::filesystem::path
		file;         ///< where the body went, for routes with Body::file; removed after the handler unless it was moved away
	std::string from; ///< the peer's address
	std::shared_ptr<Peer> peer; ///< for routes that wait; else null

	/// A query's value, or `otherwise`.
	std::string asked(const std::string& name, const std::string& otherwise = "") const {
		const auto found = query.find(name);
		return found == query.end() ? otherwise : found->second;
	}
};

/// Writes a body piece by piece, for as long as the peer reads (server-sent events).
class Sink {
public:
	virtual ~Sink() = default;
	/// False once the peer is gone.
	virtual Awaitable<bool> write(std::string text) = 0;
};

struct Response {
	int status = 200;
	std::string type = "application/json";
	std::string body;
	std::filesystem::path file;                   ///< sent instead of the body if not empty
	std::function<Awaitable<void>(Sink&)> stream; ///< likewise; the connection closes at its end
	std::map<std::string, std::string> headers;
};

/// An answer other than 200: a handler throws it, and {"error": what} goes out.
struct HttpError : std::runtime_error {
	HttpError(int s, const std::string& what) : std::runtime_error(what), status(s) {}
	int status;
};

} // namespace farm
#endif
