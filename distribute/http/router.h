// SPDX-License-Identifier: AGPL-3.0-or-later
/// Which handler answers which path.
#ifndef FARM_HTTP_ROUTER_H
#define FARM_HTTP_ROUTER_H

#include "distribute/http/message.h"

#include <cstdint>

namespace farm {

using Handler = std::function<Awaitable<Response>(Request&)>;

enum class Access { token, open };
/// Where a request's body goes; long_poll: to memory, and the handler may wait, so it is told when the peer hangs up.
enum class Body { memory, file, long_poll };

struct Route {
	std::string method;
	std::vector<std::string> pattern; ///< the path's parts; '*' stands for any one
	Handler handler;
	std::int64_t body_limit = 0; ///< bytes; 0: no body
	Body body = Body::memory;
	Access access = Access::token;
};

class Router {
public:
	/// `path` like "/v1/jobs/*/pause".
	void add(const std::string& method, const std::string& path, Handler handler, std::int64_t body_limit = 0,
		Body body = Body::memory, Access access = Access::token);
	/// The route for a request, whose parts and query it fills in from `target`; throws HttpError 404, 405 or 400.
	const Route& find(Request& request, const std::string& target) const;

private:
	std::vector<Route> routes;
};

/// Undoes %XX and, in queries, '+'; throws HttpError 400 for what is malformed or has a zero byte.
std::string url_decode(const std::string& text, bool plus_is_space);

} // namespace farm
#endif
