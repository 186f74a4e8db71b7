// SPDX-License-Identifier: AGPL-3.0-or-later
// What workers ask.
#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/protocol/fields.h"
#include "distribute/server/api.h"

#include <algorithm>

namespace farm {
namespace {

Response verdict(const std::string& why) { return answer({{"accepted", why.empty()}, {"why", why}}); }

std::vector<LeaseId> lease_list(const json& body) {
	std::vector<LeaseId> list;
	for (const auto& id : Fields(body, "heartbeat").array("leases", 5000)) {
		if (!id.is_number_integer())
			throw Error("heartbeat: leases must be whole numbers");
		list.push_back(id.get<LeaseId>());
	}
	return list;
}

} // namespace

void add_worker_routes(Router& router, Farm& farm) {
	router.add(
		"POST", "/v1/workers",
		[&farm](Request& r) -> Awaitable<Response> {
			farm.welcome(parse_object(r.body).get<Hello>(), r.from);
			co_return answer({{"protocol", protocol_version}, {"lease_seconds", farm.rules().lease}}, 201);
		},
		limits::message_bytes);
	router.add("GET", "/v1/workers", [&farm](Request&) -> Awaitable<Response> {
		json list = json::array();
		for (const auto& [id, guest] : farm.guests())
			list.push_back(describe(farm, guest));
		co_return answer({{"workers", list}});
	});
	router.add("DELETE", "/v1/workers/*", [&farm](Request& r) -> Awaitable<Response> {
		co_await farm.leave(r.parts[0]);
		co_return answer(json::object());
	});
	router.add(
		"POST", "/v1/workers/*/drain",
		[&farm](Request& r) -> Awaitable<Response> {
			farm.drain(r.parts[0], true);
			co_return answer(json::object());
		},
		limits::message_bytes);
	router.add(
		"POST", "/v1/workers/*/heartbeat",
		[&farm](Request& r) -> Awaitable<Response> {
			const auto ended = farm.beat(r.parts[0], lease_list(parse_object(r.body)));
			const auto& states = farm.schedule().workers();
			const auto state = states.find(r.parts[0]);
			co_return answer({{"drop", ended}, {"draining", state != states.end() && state->second.draining},
				{"aside", state == states.end() ? "" : state->second.aside}});
		},
		limits::message_bytes);
	router.add(
		"POST", "/v1/workers/*/take",
		[&farm](Request& r) -> Awaitable<Response> {
			const json body = parse_object(r.body);
			const double wait = Fields(body, "take").real("wait", 0, 300, 0);
			const auto task = co_await farm.take(r.parts[0], wait, r.peer);
			Response nothing;
			nothing.status = 204;
			co_return task ? answer(*task) : nothing;
		},
		limits::message_bytes, Body::long_poll);
	router.add(
		"PUT", "/v1/leases/*/strip",
		[&farm](Request& r) -> Awaitable<Response> {
			const LeaseId lease = id_of(r.parts[0], "lease");
			const std::string hash = r.asked("sha256");
			if (!is_sha256(hash))
				throw Error("sha256 is '" + hash + "'; it must be 64 hexadecimal digits");
			co_return verdict(co_await farm.report(lease, r.file, hash, real_number(r.asked("seconds", "0"), "seconds", 0, 1e9)));
		},
		limits::strip_bytes, Body::file);
	router.add(
		"POST", "/v1/leases/*/failure",
		[&farm](Request& r) -> Awaitable<Response> {
			const LeaseId lease = id_of(r.parts[0], "lease");
			co_return verdict(co_await farm.failed(lease, parse_object(r.body).get<Failure>()));
		},
		limits::message_bytes);
	router.add(
		"POST", "/v1/leases/*/return",
		[&farm](Request& r) -> Awaitable<Response> { co_return verdict(co_await farm.give_back(id_of(r.parts[0], "lease"))); },
		limits::message_bytes);
}

} // namespace farm
