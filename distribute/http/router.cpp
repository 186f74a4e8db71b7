// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/http/router.h"

namespace farm {
namespace {

int digit(char c) {
	return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::vector<std::string> split(const std::string& text, char at) {
	std::vector<std::string> parts;
	size_t from = 0;
	while (true) {
		const size_t to = text.find(at, from);
		parts.push_back(text.substr(from, to - from));
		if (to == std::string::npos)
			return parts;
		from = to + 1;
	}
}

} // namespace

std::string url_decode(const std::string& text, bool plus_is_space) {
	std::string plain;
	for (size_t i = 0; i < text.size(); ++i) {
		char c = text[i];
		if (c == '%') {
			const int high = i + 2 < text.size() ? digit(text[i + 1]) : -1, low = i + 2 < text.size() ? digit(text[i + 2]) : -1;
			if (high < 0 || low < 0 || high + low == 0)
				throw HttpError(400, "the address is malformed");
			c = static_cast<char>(16 * high + low);
			i += 2;
		} else if (c == '+' && plus_is_space) {
			c = ' ';
		}
		plain += c;
	}
	return plain;
}

void Router::add(
	const std::string& method, const std::string& path, Handler handler, std::int64_t limit, Body body, Access access) {
	routes.push_back({method, split(path, '/'), std::move(handler), limit, body, access});
}

const Route& Router::find(Request& request, const std::string& target) const {
	const size_t mark = target.find('?');
	request.path = target.substr(0, mark);
	if (mark != std::string::npos)
		for (const auto& pair : split(target.substr(mark + 1), '&')) {
			const size_t equals = pair.find('=');
			request.query[url_decode(pair.substr(0, equals), true)] =
				equals == std::string::npos ? "" : url_decode(pair.substr(equals + 1), true);
		}
	// Split before decoding: an encoded slash is part of a name, and refused by whoever takes it for a file's.
	auto parts = split(request.path, '/');
	for (auto& part : parts)
		part = url_decode(part, false);
	bool path_known = false;
	for (const Route& route : routes) {
		if (route.pattern.size() != parts.size())
			continue;
		std::vector<std::string> stars;
		bool fits = true;
		for (size_t i = 0; i < parts.size() && fits; ++i) {
			if (route.pattern[i] == "*" && !parts[i].empty())
				stars.push_back(parts[i]);
			else
				fits = route.pattern[i] == parts[i];
		}
		if (!fits)
			continue;
		path_known = true;
		if (route.method == request.method || (request.method == "HEAD" && route.method == "GET")) {
			request.parts = std::move(stars);
			return route;
		}
	}
	if (path_known)
		throw HttpError(405, request.method + " is not for " + request.path);
	throw HttpError(404, "there is no " + request.path);
}

} // namespace farm
