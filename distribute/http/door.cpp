// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/http/door.h"

#include "distribute/common/hash.h"

#include <algorithm>
#include <ctime>

namespace farm {
namespace {

constexpr double week = 7 * 86400;
constexpr size_t most_sessions = 10000;

const std::string* header(const Request& request, const char* name) {
	const auto found = request.headers.find(name);
	return found == request.headers.end() ? nullptr : &found->second;
}

bool is_safe(const std::string& method) { return method == "GET" || method == "HEAD"; }

/// What follows the scheme in an origin, which is also what Host has.
std::string host_of(const std::string& origin) {
	const size_t slashes = origin.find("://");
	return slashes == std::string::npos ? "" : origin.substr(slashes + 3);
}

/// A name that no stranger's name server can make its own.
bool is_here(const std::string& host) {
	const bool v6 = !host.empty() && host[0] == '[';
	const std::string name = v6 ? host.substr(0, host.find(']') + 1) : host.substr(0, host.find(':'));
	return name.empty() || name == "localhost" || name == "[::1]" ||
		   (name.rfind("127.", 0) == 0 && name.find_first_not_of("0123456789.") == std::string::npos);
}

} // namespace

void Door::stands_at(int port, bool tls) {
	// The prefix: a browser takes such a cookie from us alone, and under TLS.
	name = (tls ? "__Host-bhfarm-" : "bhfarm-") + std::to_string(port);
	attributes = std::string("; Path=/; HttpOnly; SameSite=Strict") + (tls ? "; Secure" : "");
}

bool Door::good(const std::string& token) const {
	bool good = false;
	for (const auto& known : tokens)
		good = same_secret(known, token) || good;
	return good;
}

bool Door::from_own_page(const Request& request) {
	if (const auto* site = header(request, "sec-fetch-site"))
		return *site == "same-origin";
	const auto *origin = header(request, "origin"), *host = header(request, "host");
	return origin && host && host_of(*origin) == *host;
}

std::string Door::cookie(const Request& request) const {
	const auto* line = header(request, "cookie");
	for (size_t at = 0; line && at < line->size();) {
		const size_t end = std::min(line->find(';', at), line->size());
		if (line->compare(at, name.size() + 1, name + "=") == 0 && at + name.size() + 1 <= end)
			return line->substr(at + name.size() + 1, end - at - name.size() - 1);
		at = line->find_first_not_of("; ", end);
	}
	return "";
}

void Door::check(const Request& request) const {
	if (tokens.empty()) {
		const auto* host = header(request, "host");
		const bool by_page = header(request, "origin") || header(request, "sec-fetch-site");
		if (host && !is_here(*host))
			throw HttpError(403, "this server has no tokens and answers to localhost only, not to '" + *host + "'");
		if (!is_safe(request.method) && by_page && !from_own_page(request))
			throw HttpError(403, "a page of another origin may not do that");
		return;
	}
	const std::string prefix = "Bearer ";
	if (const auto* line = header(request, "authorization"); line && line->compare(0, prefix.size(), prefix) == 0) {
		if (good(line->substr(prefix.size())))
			return;
	} else if (const std::string given = cookie(request); !given.empty()) {
		const auto session = sessions.find(sha256(given));
		const auto now = static_cast<double>(std::time(nullptr));
		if (session != sessions.end() && now - session->second < week) {
			session->second = now;
			if (!is_safe(request.method) && !from_own_page(request))
				throw HttpError(403, "a page of another origin may not do that");
			return;
		}
	}
	throw HttpError(401, "a token is needed: Authorization: Bearer TOKEN");
}

std::string Door::let_in() {
	const auto used_before = [](const auto& a, const auto& b) { return a.second < b.second; };
	if (sessions.size() >= most_sessions)
		sessions.erase(std::min_element(sessions.begin(), sessions.end(), used_before));
	const std::string fresh = random_hex(32);
	// By its hash: a look-up's time tells nothing about the cookies there are.
	sessions[sha256(fresh)] = static_cast<double>(std::time(nullptr));
	return name + "=" + fresh + attributes + "; Max-Age=" + std::to_string(static_cast<int>(week));
}

std::string Door::let_out(const Request& request) {
	sessions.erase(sha256(cookie(request)));
	return name + "=" + attributes + "; Max-Age=0";
}

} // namespace farm
