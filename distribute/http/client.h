// SPDX-License-Identifier: AGPL-3.0-or-later
/// Requests to a bhfarm server, by libcurl. One object for one thread at a time; it keeps its connection open.
#ifndef FARM_HTTP_CLIENT_H
#define FARM_HTTP_CLIENT_H

#include "distribute/common/arguments.h"
#include "distribute/common/error.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace farm {

/// Where the server is and how to be let in.
struct Access_to {
	std::string url = "http://127.0.0.1:7700";
	std::string token;               ///< empty: none
	std::filesystem::path authority; ///< PEM of one's own CA; empty: the system's
};

/// The server could not be reached, or the connection broke: trying again may help.
struct Unreachable : Error {
	using Error::Error;
};

/// It could not, and will not be before somebody mends an address or a certificate.
struct Distrusted : Unreachable {
	using Unreachable::Unreachable;
};

/// The server answered, and not with what was asked for.
struct Refused : Error {
	Refused(int s, const std::string& what) : Error(what), status(s) {}
	int status;
};

class Client {
public:
	explicit Client(const Access_to& access);
	~Client();
	Client(Client&& other) noexcept;
	Client(const Client&) = delete;

	/// Each throws Unreachable or Refused. Paths start with a slash; 204 gives a null.
	nlohmann::json get(const std::string& path);
	nlohmann::json post(const std::string& path, const nlohmann::json& body);
	/// A long poll: `seconds` on top of the usual patience.
	nlohmann::json post(const std::string& path, const nlohmann::json& body, double seconds);
	nlohmann::json remove(const std::string& path);
	nlohmann::json put(const std::string& path, const std::string& body);
	nlohmann::json put_file(const std::string& path, const std::filesystem::path& file);
	/// To a file, whole or not at all.
	void download(const std::string& path, const std::filesystem::path& file);
	/// Makes the request under way end with Unreachable; for another thread or a signal's flag.
	void stop_when(const std::atomic<bool>* flag) { stop = flag; }

private:
	struct Ask;
	nlohmann::json ask(Ask& request);
	void* handle;
	Access_to access;
	const std::atomic<bool>* stop = nullptr;
};

/// --server, --token-file and --ca, of all that talk to a server.
extern const std::vector<Option> access_options;
/// What they say or, where they are empty, BHFARM_SERVER, BHFARM_TOKEN_FILE and BHFARM_CA. Throws Error for a token file that
/// cannot be read.
Access_to access_from(const Arguments& arguments);
Access_to access_from(const std::string& url, const std::string& token_file, const std::string& authority);

/// Whether HOST:PORT (or HOST) is this machine alone.
bool on_loopback(const std::string& address);

/// %XX for what may not stand in a path's part.
std::string url_encode(const std::string& text);

} // namespace farm
#endif
