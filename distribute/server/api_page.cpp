// SPDX-License-Identifier: AGPL-3.0-or-later
// The page to watch, the sign-in in front of it, and the source of what runs here.
#include "distribute/common/hash.h"
#include "distribute/server/api.h"
#include "distribute/server/page_files.h"

namespace farm {
namespace {

// All that the page loads comes from here, and nothing that it shows can become part of it.
const char* const policy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
						   "form-action 'self'; base-uri 'none'; frame-ancestors 'none'";

void fence(Response& r, const std::string& security_policy) {
	r.headers["Content-Security-Policy"] = security_policy;
	r.headers["Cross-Origin-Opener-Policy"] = "same-origin";
	r.headers["Cross-Origin-Resource-Policy"] = "same-origin";
	r.headers["Referrer-Policy"] = "same-origin";
}

Response page(const Request& request, const PageFile& file) {
	Response r;
	r.type = file.type;
	r.headers["ETag"] = std::string(file.etag);
	r.headers["Cache-Control"] = "private, no-cache"; // asked for every time, sent once
	fence(r, policy);
	const auto known = request.headers.find("if-none-match");
	if (known != request.headers.end() && known->second == file.etag)
		r.status = 304;
	else
		r.body = file.body;
	return r;
}

void put_in(std::string& text, const std::string& mark, const std::string& what) {
	for (size_t at; (at = text.find(mark)) != std::string::npos;)
		text.replace(at, mark.size(), what);
}

Response redirect(const std::string& where) {
	Response r;
	r.status = 303;
	r.type = "text/plain";
	r.headers["Location"] = where;
	return r;
}

} // namespace

Response sign_in_page(const std::string& word) {
	const std::string nonce = random_hex(16);
	Response r;
	r.status = 401;
	r.type = "text/html; charset=utf-8";
	r.headers["WWW-Authenticate"] = "Bearer realm=\"bhfarm\"";
	r.headers["Cache-Control"] = "no-store";
	fence(r, "default-src 'none'; style-src 'nonce-" + nonce + "'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'");
	r.body = page_file("sign_in.html").body;
	put_in(r.body, "@NONCE@", nonce);
	put_in(r.body, "@WORD@", word);
	return r;
}

void add_page_routes(Router& router, Door& door) {
	// Who came in by a token may want to leave.
	static std::string index(page_file("index.html").body), tag(page_file("index.html").etag);
	if (door.needs_token()) {
		put_in(index, " hidden>Sign out", ">Sign out");
		tag = std::string("\"signed-in-").append(tag, 1);
	}
	router.add("GET", "/", [](Request& r) -> Awaitable<Response> {
		co_return page(r, {"index.html", page_file("index.html").type, tag, index});
	});
	router.add("GET", "/page/*", [](Request& r) -> Awaitable<Response> {
		for (const PageFile& file : page_files)
			if (file.name == r.parts[0] && file.name != "sign_in.html")
				co_return page(r, file);
		throw HttpError(404, "there is no " + r.path);
	});
	router.add(
		"POST", "/sign-in",
		[&door](Request& r) -> Awaitable<Response> {
			if (!Door::from_own_page(r))
				throw HttpError(403, "this is for the server's own page");
			std::string token = r.body.rfind("token=", 0) == 0 ? url_decode(r.body.substr(6), true) : "";
			token.erase(0, token.find_first_not_of(" \t\r\n"));
			token.erase(token.find_last_not_of(" \t\r\n") + 1);
			if (door.needs_token() && !door.good(token))
				co_return sign_in_page("That is not a token of this farm.");
			Response r2 = redirect("/");
			if (door.needs_token())
				r2.headers["Set-Cookie"] = door.let_in();
			co_return r2;
		},
		4096, Body::memory, Access::open);
	router.add("POST", "/sign-out", [&door](Request& r) -> Awaitable<Response> {
		Response gone = redirect("/");
		gone.headers["Set-Cookie"] = door.let_out(r);
		co_return gone;
	});
	router.add("GET", "/source", [](Request&) -> Awaitable<Response> {
		Response r;
		r.type = "application/gzip";
		r.headers["Content-Disposition"] = "attachment; filename=\"povray-blackhole.tar.gz\"";
		r.body = source_archive();
		co_return r;
	});
}

} // namespace farm
