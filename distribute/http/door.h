// SPDX-License-Identifier: AGPL-3.0-or-later
/// Who is let in: programs by a token, browsers by a cookie that a token was given for. Cookies are forgotten with the server.
#ifndef FARM_HTTP_DOOR_H
#define FARM_HTTP_DOOR_H

#include "distribute/http/message.h"

#include <map>

namespace farm {

class Door {
public:
	/// Without tokens everybody on this machine comes in, except by way of a stranger's web page.
	explicit Door(std::vector<std::string> known) : tokens(std::move(known)) {}
	/// Browsers keep cookies by host, whatever the port: ours has the port in its name.
	void stands_at(int port, bool tls);

	/// Throws HttpError 401 for who has no token, 403 for a page of another origin that acts in the name of who has.
	void check(const Request& request) const;

	bool good(const std::string& token) const;
	/// A cookie, as a Set-Cookie line. For who has shown a token.
	std::string let_in();
	/// Forgets the request's cookie; what to tell the browser.
	std::string let_out(const Request& request);
	/// Whether a page of this server asked for it, as far as the browser says.
	static bool from_own_page(const Request& request);
	bool needs_token() const { return !tokens.empty(); }

private:
	std::string cookie(const Request& request) const;

	std::vector<std::string> tokens;
	std::string name = "bhfarm", attributes;
	mutable std::map<std::string, double> sessions; ///< by the cookie's SHA-256: when last used, seconds since 1970
};

} // namespace farm
#endif
