// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/http/server.h"

#include "distribute/common/error.h"
#include "distribute/http/send.h"

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>
#include <limits>
#include <sys/socket.h>

namespace farm {

using asio::ip::tcp;

struct Connection {
	beast::flat_buffer buffer;
	std::string from;
	bool unread = false; ///< an answer went out before the request was read to its end
};

namespace {

constexpr size_t most_read = 1 << 15; ///< bytes at a time
/// Bodies up to so many bytes go to their files in one piece, as long as all of those together are no more than this.
constexpr std::uint64_t small_body = 4 << 20, most_in_memory = 64 << 20;

/// Counts something for as long as it lives.
struct Count {
	Count(std::uint64_t& s, std::uint64_t n) : sum(s), number(n) { sum += number; }
	~Count() { sum -= number; }
	Count(const Count&) = delete;
	std::uint64_t &sum, number;
};

constexpr std::uint32_t longest_header = 16 << 10;

auto patience(double seconds) { return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds)); }

/// Looks out for the end of a connection while nothing is read from it.
void look_out(tcp::socket& socket, const std::shared_ptr<Peer>& peer) {
	socket.async_wait(tcp::socket::wait_read, [&socket, peer](const Code& error) {
		char c = 0;
		if (error || ::recv(socket.native_handle(), &c, 1, MSG_PEEK | MSG_DONTWAIT) > 0)
			return; // the answer is on its way, or the peer has sent more already
		peer->gone = true;
		if (peer->tell)
			peer->tell();
	});
}

template <class Fields> void copy_headers(const Fields& fields, Request& request) {
	for (const auto& field : fields) {
		std::string name(field.name_string());
		for (char& c : name)
			c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
		request.headers[name] = std::string(field.value());
	}
}

} // namespace

HttpServer::HttpServer(asio::io_context& c, const Router& r, ServerSettings s)
	: context(c), router(r), settings(std::move(s)), acceptor(c) {
	if (settings.tls_certificate.empty() && settings.tls_key.empty())
		return;
	tls.emplace(asio::ssl::context::tls_server);
	Code error;
	tls->use_certificate_chain_file(settings.tls_certificate.string(), error);
	if (error)
		throw Error("cannot use the certificate " + settings.tls_certificate.string() + ": " + error.message());
	tls->use_private_key_file(settings.tls_key.string(), asio::ssl::context::pem, error);
	if (error)
		throw Error("cannot use the key " + settings.tls_key.string() + ": " + error.message());
}

void HttpServer::listen(const std::string& address) {
	const size_t colon = address.rfind(':');
	if (colon == std::string::npos || address.find_first_not_of("0123456789", colon + 1) != std::string::npos ||
		colon + 1 == address.size())
		throw Error("the address to listen on is '" + address + "'; it must be ADDRESS:PORT");
	std::string host = address.substr(0, colon);
	if (host.size() > 2 && host.front() == '[' && host.back() == ']')
		host = host.substr(1, host.size() - 2);
	Code error;
	tcp::resolver resolver(context);
	const auto found = resolver.resolve(host, address.substr(colon + 1), tcp::resolver::passive, error);
	if (error || found.empty())
		throw Error("cannot listen on " + address + ": " + error.message());
	const tcp::endpoint place = found.begin()->endpoint();
	acceptor.open(place.protocol());
	acceptor.set_option(tcp::acceptor::reuse_address(true));
	acceptor.bind(place, error);
	if (!error)
		acceptor.listen(4096, error);
	if (error)
		throw Error("cannot listen on " + address + ": " + error.message());
	settings.door->stands_at(acceptor.local_endpoint().port(), tls.has_value());
	asio::co_spawn(context, accept(), asio::detached);
}

std::string HttpServer::url() const {
	const auto place = acceptor.local_endpoint();
	const std::string host = place.address().is_v6() ? "[" + place.address().to_string() + "]" : place.address().to_string();
	return (tls ? "https://" : "http://") + host + ":" + std::to_string(place.port());
}

void HttpServer::close() {
	Code ignored;
	acceptor.close(ignored);
}

Awaitable<void> HttpServer::accept() {
	while (acceptor.is_open()) {
		Code error;
		tcp::socket socket = co_await acceptor.async_accept(asio::redirect_error(asio::use_awaitable, error));
		if (!error) {
			asio::co_spawn(context, connection(std::move(socket)), asio::detached);
		} else if (error != asio::error::operation_aborted) { // out of descriptors: they come back
			asio::steady_timer timer(context, patience(0.1));
			co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
		}
	}
}

Awaitable<void> HttpServer::connection(tcp::socket socket) {
	Code error;
	socket.set_option(tcp::no_delay(true), error);
	const auto peer = socket.remote_endpoint(error);
	std::string from = error ? "?" : peer.address().to_string();
	++open;
	beast::tcp_stream plain(std::move(socket));
	try {
		if (tls) {
			beast::ssl_stream<beast::tcp_stream> stream(std::move(plain), *tls);
			beast::get_lowest_layer(stream).expires_after(patience(settings.header_seconds));
			co_await stream.async_handshake(asio::ssl::stream_base::server, asio::redirect_error(asio::use_awaitable, error));
			if (!error)
				co_await serve(stream, std::move(from));
		} else {
			co_await serve(plain, std::move(from));
			plain.socket().shutdown(tcp::socket::shutdown_send, error);
		}
	} catch (const std::exception& e) {
		say(std::string("a connection ended badly: ") + e.what());
	}
	--open;
}

template <class Stream> Awaitable<void> HttpServer::serve(Stream& stream, std::string from) {
	Connection connection;
	connection.from = std::move(from);
	bool more = true;
	while (more)
		more = co_await exchange(stream, connection);
	if (!connection.unread)
		co_return;
	// Closed at once, what still comes in would make the system throw away what has gone out: the peer would not learn why.
	Code error;
	beast::get_lowest_layer(stream).expires_after(std::chrono::seconds(5));
	std::vector<char> rest(1 << 16);
	for (int pieces = 0; pieces < 1 << 10 && !error; ++pieces)
		co_await stream.async_read_some(asio::buffer(rest), asio::redirect_error(asio::use_awaitable, error));
}

template <class Stream, class Header>
Awaitable<Code> HttpServer::read_body(
	Stream& stream, Connection& connection, Header& header, const Route& route, Request& request) {
	Code error;
	const auto limit = static_cast<std::uint64_t>(route.body_limit);
	const std::uint64_t length = header.content_length().value_or(limit);
	const bool to_file = route.body == Body::file;
	if (to_file)
		request.file = settings.fresh_file();
	if (to_file && (length > small_body || in_memory + length > most_in_memory)) {
		http::request_parser<http::file_body> body(std::move(header));
		body.body_limit(limit);
		body.get().body().open(request.file.c_str(), beast::file_mode::write, error);
		if (error)
			throw HttpError(507, "cannot write: " + error.message());
		co_await http::async_read(stream, connection.buffer, body, asio::redirect_error(asio::use_awaitable, error));
		co_return error;
	}
	const Count count(in_memory, to_file ? length : 0);
	http::request_parser<http::string_body> body(std::move(header));
	body.body_limit(limit);
	co_await http::async_read(stream, connection.buffer, body, asio::redirect_error(asio::use_awaitable, error));
	if (error || !to_file)
		request.body = std::move(body.get().body());
	else
		co_await settings.write_file(request.file, body.get().body());
	co_return error;
}

// One request and its answer; false when the connection is to be closed.
template <class Stream> Awaitable<bool> HttpServer::exchange(Stream& stream, Connection& connection) {
	auto& lowest = beast::get_lowest_layer(stream);
	Code error;
	http::request_parser<http::empty_body> header;
	header.header_limit(longest_header);
	header.body_limit(std::numeric_limits<std::uint64_t>::max()); // the route's own follows
	lowest.expires_after(patience(settings.header_seconds));
	co_await http::async_read_header(stream, connection.buffer, header, asio::redirect_error(asio::use_awaitable, error));
	if (error.category() == http::make_error_code(http::error::bad_target).category() && error != http::error::end_of_stream &&
		error != http::error::partial_message) {
		connection.unread = true;
		Response refusal = error == http::error::header_limit
							   ? error_response(431, "the headers are longer than " + std::to_string(longest_header) + " bytes")
							   : error_response(400, "that is no HTTP request: " + error.message());
		lowest.expires_after(patience(settings.body_seconds));
		co_return co_await send(stream, refusal, 11, false, false);
	}
	if (error)
		co_return false;

	const unsigned version = header.get().version();
	Request request;
	request.method = std::string(header.get().method_string());
	request.from = connection.from;
	copy_headers(header.get(), request);
	const bool keep = header.get().keep_alive();
	bool body_read = false;
	Response response;
	try {
		const Route& route = router.find(request, std::string(header.get().target()));
		if (route.access == Access::token)
			settings.door->check(request);
		if (open > settings.connections)
			throw HttpError(503, "too many connections");
		const auto limit = static_cast<std::uint64_t>(route.body_limit);
		if (const auto length = header.content_length(); length && *length > limit)
			throw HttpError(413, "the body has " + std::to_string(*length) + " bytes; " + std::to_string(limit) + " are allowed");
		if (request.headers.count("expect")) {
			http::response<http::empty_body> go_on(http::status::continue_, version);
			co_await http::async_write(stream, go_on, asio::redirect_error(asio::use_awaitable, error));
		}
		lowest.expires_after(patience(settings.body_seconds));
		// Beast reads as much at a time as there is room for. Those that wait keep none.
		if (route.body_limit > 0)
			connection.buffer.reserve(std::min<size_t>(header.content_length().value_or(most_read), most_read));
		error = co_await read_body(stream, connection, header, route, request);
		if (error == http::error::body_limit)
			throw HttpError(413, "the body is longer than " + std::to_string(limit) + " bytes");
		if (error.category() == boost::system::generic_category() || error.category() == boost::system::system_category()) {
			if (error == boost::system::errc::no_space_on_device)
				throw Error("cannot write " + request.file.string() + ": " + error.message(), ENOSPC);
		}
		if (error) {
			std::error_code ignored;
			if (!request.file.empty())
				std::filesystem::remove(request.file, ignored);
			co_return false;
		}
		body_read = true;
		connection.buffer.shrink_to_fit();
		lowest.expires_never();
		if (route.body == Body::long_poll) {
			request.peer = std::make_shared<Peer>();
			look_out(lowest.socket(), request.peer);
		}
		response = co_await route.handler(request);
		if (request.peer)
			lowest.socket().cancel(error);
		if (request.peer && request.peer->gone)
			co_return false;
	} catch (const HttpError& e) {
		if (e.status == 507 && settings.full)
			settings.full(e.what());
		response =
			e.status == 401 && request.path == "/" && settings.sign_in ? settings.sign_in() : error_response(e.status, e.what());
	} catch (const Error& e) {
		// What the system would not do is no fault of the request's.
		response = error_response(e.disk_full() ? 507 : e.number ? 500 : 400, e.what());
		if (e.disk_full() && settings.full)
			settings.full(e.what());
	} catch (const std::exception& e) {
		say("while answering " + request.method + " " + request.path + ": " + e.what());
		response = error_response(500, e.what());
	}
	if (!request.file.empty()) {
		std::error_code ignored;
		std::filesystem::remove(request.file, ignored);
	}
	if (!response.stream)
		lowest.expires_after(patience(settings.body_seconds));
	// A body that was not read would be taken for the next request.
	connection.unread = !body_read;
	co_return co_await send(stream, response, version, keep && body_read, request.method == "HEAD");
}

} // namespace farm
