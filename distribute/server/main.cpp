// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm-server: keeps the ledger, lends strips, stitches frames.
#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/http/client.h"
#include "distribute/http/server.h"
#include "distribute/server/api.h"
#include "distribute/server/page_files.h"

#include <boost/asio/signal_set.hpp>

#include <cstring>
#include <malloc.h>
#include <sstream>
#include <sys/resource.h>

namespace {

using namespace farm;

const std::vector<Option> options = {
	{"--listen", "ADDR:PORT", "where to listen; other than on loopback a token is needed", "127.0.0.1:7700"},
	{"--spool", "DIR", "the server's folder; default $XDG_STATE_HOME/bhfarm/spool", ""},
	{"--token-file", "FILE", "tokens that let in, one a line; also from BHFARM_TOKEN_FILE", ""},
	{"--tls-cert", "FILE", "certificate chain, PEM", ""},
	{"--tls-key", "FILE", "its key, PEM", ""},
	{"--idle", "SECONDS", "a connection that asks for nothing in so long is closed", "60"},
	{"--lease", "SECONDS", "a worker that is silent for so long loses its strips", "20"},
	{"--check-every", "N", "one strip in N, and each worker's first, is rendered by two; 0: none", "32"},
	{"--keep-days", "N", "jobs that have ended are removed after so long", "30"},
	{"--keep-gb", "N", "and the oldest of them while the spool is larger; 0: whatever it is", "0"},
	{"--source", "", "writes the source of this program and of povray's changes to stdout, as .tar.gz", ""},
};

std::vector<std::string> read_tokens(const std::string& given) {
	const std::string file = or_environment(given, "BHFARM_TOKEN_FILE");
	std::vector<std::string> tokens;
	if (file.empty())
		return tokens;
	std::istringstream lines(read_secret(file));
	for (std::string line; std::getline(lines, line);)
		if (line = line.substr(0, line.find_first_of("\r \t#")); !line.empty())
			tokens.push_back(line);
	if (tokens.empty())
		throw Error("the token file " + file + " has no token; 'bhfarm token new' makes one");
	return tokens;
}

int serve(const Arguments& arguments) {
	boost::asio::io_context context(1);
	FarmSettings settings;
	settings.spool = arguments.get("--spool").empty() ? state_folder() / "spool" : fs::path(arguments.get("--spool"));
	settings.rules.lease = static_cast<double>(arguments.number("--lease", 1, 86400));
	settings.rules.lease_gap = 1 << 16;
	settings.rules.check_every = static_cast<int>(arguments.number("--check-every", 0, 1000000));
	settings.keep_days = arguments.real("--keep-days", 0, 100000);
	settings.keep_bytes = 1e9 * arguments.real("--keep-gb", 0, 1000000);
	ServerSettings http;
	http.header_seconds = static_cast<double>(arguments.number("--idle", 1, 86400));
	http.door = std::make_shared<Door>(read_tokens(arguments.get("--token-file")));
	http.sign_in = [] { return sign_in_page(); };
	http.tls_certificate = arguments.get("--tls-cert");
	http.tls_key = arguments.get("--tls-key");
	if (http.tls_certificate.empty() != http.tls_key.empty())
		throw Error("--tls-cert and --tls-key go together");
	const std::string& address = arguments.get("--listen");
	const size_t colon = address.rfind(':');
	whole_number(colon == std::string::npos ? "" : address.substr(colon + 1), "the port in --listen ADDR:PORT", 0, 65535);
	if (!http.door->needs_token() && !on_loopback(address))
		throw Error("--listen " + address + " is open to others: give a --token-file ('bhfarm token new' makes one)");

	// Strips are unpacked by the thousand: the memory for one serves for the next, rather than going back to the system.
	mallopt(M_MMAP_THRESHOLD, 32 << 20);
	mallopt(M_TRIM_THRESHOLD, 64 << 20);
	// A connection is a descriptor.
	rlimit descriptors{};
	if (getrlimit(RLIMIT_NOFILE, &descriptors) == 0) {
		descriptors.rlim_cur = descriptors.rlim_max;
		setrlimit(RLIMIT_NOFILE, &descriptors);
	}

	Farm farm(context, settings);
	Router router;
	router.add(
		"GET", "/health",
		[](Request&) -> Awaitable<Response> {
			co_return answer({{"ok", true}, {"protocol", protocol_version}});
		},
		0, Body::memory, Access::open);
	add_job_routes(router, farm);
	add_worker_routes(router, farm);
	add_bundle_routes(router, farm);
	add_watch_routes(router, farm);
	add_page_routes(router, *http.door);
	http.full = [&farm](const std::string& what) { farm.complain(what); };
	http.fresh_file = [&farm] { return farm.files().fresh(); };
	http.write_file = [&farm](const fs::path& file, const std::string& body) -> Awaitable<void> {
		const auto write = [&file, &body] { return write_file(file, body); };
		const int error = co_await in_pool(farm.io(), farm.threads(), write);
		if (error)
			throw HttpError(507, std::string("cannot write: ") + std::strerror(error));
	};
	HttpServer server(context, router, http);
	server.listen(address);
	write_durably(farm.files().url(), server.url() + "\n");
	say("listening on " + server.url() + ", spool " + fs::absolute(settings.spool).string());

	boost::asio::signal_set signals(context, SIGINT, SIGTERM);
	signals.async_wait([&](const boost::system::error_code&, int) { context.stop(); });
	context.run();
	server.close();
	std::error_code ignored;
	fs::remove(farm.files().url(), ignored);
	farm.book().write([](Database&) {}); // all that was queued before is on the disk
	// Coroutines that wait for ever are not worth taking apart.
	std::_Exit(0);
}

} // namespace

int main(int argc, char** argv) {
	return run_program("bhfarm-server", true, [&] {
		const Arguments arguments({argv + 1, argv + argc}, options);
		help_if_asked(arguments,
			"bhfarm-server [options]\nKeeps jobs and lends their strips to workers. docs/manual.md has more.", options);
		if (arguments.has("--source")) {
			write_out(source_archive(), "the source");
			return 0;
		}
		no_other_words(arguments);
		return serve(arguments);
	});
}
