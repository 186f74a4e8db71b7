// SPDX-License-Identifier: AGPL-3.0-or-later
/// An HTTP/1.1 server on one thread: a coroutine a connection.
#ifndef FARM_HTTP_SERVER_H
#define FARM_HTTP_SERVER_H

#include "distribute/http/door.h"
#include "distribute/http/router.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>

#include <optional>

namespace farm {

struct ServerSettings {
	std::shared_ptr<Door> door;                        ///< never null
	std::function<Response()> sign_in;                 ///< the answer to who asks for / and is not let in
	std::filesystem::path tls_certificate, tls_key;    ///< PEM; both empty: plain HTTP
	std::function<std::filesystem::path()> fresh_file; ///< names for bodies that go to files
	/// Writes such a body elsewhere than on this thread, which would wait for the disk. Throws HttpError.
	std::function<Awaitable<void>(const std::filesystem::path& file, const std::string& body)> write_file;
	std::function<void(const std::string& what)> full; ///< called when a disk has no room for what came
	int connections = 60000;                           ///< more are turned away with 503
	double header_seconds = 60;                        ///< an idle connection is closed after this
	double body_seconds = 600;                         ///< the most one body may take
};

class HttpServer {
public:
	/// The router and the context outlive this.
	HttpServer(boost::asio::io_context& context, const Router& router, ServerSettings settings);
	/// ADDR:PORT, [V6]:PORT or a host's name; port 0 takes a free one. Throws Error.
	void listen(const std::string& address);
	/// Where it listens, as http://127.0.0.1:7700.
	std::string url() const;
	/// Takes no new connections.
	void close();
	int connections() const { return open; }

private:
	Awaitable<void> accept();
	template <class Stream> Awaitable<void> serve(Stream& stream, std::string from);
	template <class Stream> Awaitable<bool> exchange(Stream& stream, struct Connection& connection);
	Awaitable<void> connection(boost::asio::ip::tcp::socket socket);
	template <class Stream, class Header>
	Awaitable<boost::system::error_code> read_body(
		Stream& stream, Connection& connection, Header& header, const Route& route, Request& request);

	boost::asio::io_context& context;
	const Router& router;
	ServerSettings settings;
	std::optional<boost::asio::ssl::context> tls;
	boost::asio::ip::tcp::acceptor acceptor;
	int open = 0;
	std::uint64_t in_memory = 0; // bytes of bodies on their way to files
};

} // namespace farm
#endif
