// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/http/server.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <boost/beast/ssl.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <limits>

namespace farm {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Code = boost::system::error_code;
using asio::ip::tcp;

struct Connection {
	beast::flat_buffer buffer;
	std::string from;
};

namespace {

auto patience(double seconds) { return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds)); }

template <class Fields> void copy_headers(const Fields& fields, Request& request) {
	for (const auto& field : fields) {
		std::string name(field.name_string());
		for (char& c : name)
			c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
		request.headers[name] = std::string(field.value());
	}
}

template <class Body> http::response<Body> head(const Response& from, unsigned version, bool keep) {
	http::response<Body> answer(static_cast<http::status>(from.status), version);
	answer.set(http::field::server, "bhfarm");
	answer.set(http::field::content_type, from.type);
	for (const auto& [name, value] : from.headers)
		answer.set(name, value);
	answer.keep_alive(keep);
	return answer;
}

Response error_response(int status, const std::string& what) {
	Response response;
	response.status = status;
	response.body = nlohmann::json{{"error", what}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
	return response;
}

template <class Stream> class ChunkSink : public Sink {
public:
	explicit ChunkSink(Stream& s) : stream(s) {}
	Awaitable<bool> write(std::string text) override {
		if (text.empty())
			co_return alive;
		Code error;
		beast::get_lowest_layer(stream).expires_after(std::chrono::seconds(30));
		co_await asio::async_write(
			stream, http::make_chunk(asio::buffer(text)), asio::redirect_error(asio::use_awaitable, error));
		beast::get_lowest_layer(stream).expires_never();
		alive = !error;
		co_return alive;
	}

private:
	Stream& stream;
	bool alive = true;
};

template <class Stream> Awaitable<bool> send(Stream& stream, Response& from, unsigned version, bool keep, bool only_head) {
	Code error;
	if (from.stream && !only_head) {
		auto answer = head<http::empty_body>(from, version, false);
		answer.chunked(true);
		http::response_serializer<http::empty_body> serializer(answer);
		co_await http::async_write_header(stream, serializer, asio::redirect_error(asio::use_awaitable, error));
		if (!error) {
			ChunkSink<Stream> sink(stream);
			co_await from.stream(sink);
			co_await asio::async_write(stream, http::make_chunk_last(), asio::redirect_error(asio::use_awaitable, error));
		}
		co_return false;
	}
	if (!from.file.empty()) {
		http::file_body::value_type body;
		body.open(from.file.c_str(), beast::file_mode::scan, error);
		if (!error) {
			auto answer = head<http::file_body>(from, version, keep);
			const auto size = body.size();
			answer.body() = std::move(body);
			answer.content_length(size);
			http::response_serializer<http::file_body> serializer(answer);
			if (only_head)
				co_await http::async_write_header(stream, serializer, asio::redirect_error(asio::use_awaitable, error));
			else
				co_await http::async_write(stream, serializer, asio::redirect_error(asio::use_awaitable, error));
			co_return !error && keep;
		}
		from = error_response(404, "it is not there");
	}
	auto answer = head<http::string_body>(from, version, keep);
	answer.content_length(from.body.size());
	if (!only_head)
		answer.body() = std::move(from.body);
	http::response_serializer<http::string_body> serializer(answer);
	co_await http::async_write(stream, serializer, asio::redirect_error(asio::use_awaitable, error));
	co_return !error && keep;
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
}

bool HttpServer::admits(const Request& request) const {
	if (settings.tokens.empty())
		return true;
	const auto found = request.headers.find("authorization");
	const std::string prefix = "Bearer ";
	if (found == request.headers.end() || found->second.compare(0, prefix.size(), prefix) != 0)
		return false;
	bool good = false;
	for (const auto& token : settings.tokens)
		good = same_secret(token, found->second.substr(prefix.size())) || good;
	return good;
}

// One request and its answer; false when the connection is to be closed.
template <class Stream> Awaitable<bool> HttpServer::exchange(Stream& stream, Connection& connection) {
	auto& lowest = beast::get_lowest_layer(stream);
	Code error;
	http::request_parser<http::empty_body> header;
	header.header_limit(16 << 10);
	header.body_limit(std::numeric_limits<std::uint64_t>::max()); // the route's own follows
	lowest.expires_after(patience(settings.header_seconds));
	co_await http::async_read_header(stream, connection.buffer, header, asio::redirect_error(asio::use_awaitable, error));
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
		if (route.access == Access::token && !admits(request))
			throw HttpError(401, "a token is needed: Authorization: Bearer TOKEN");
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
		if (route.body == Body::file) {
			request.file = settings.fresh_file();
			http::request_parser<http::file_body> body(std::move(header));
			body.body_limit(limit);
			body.get().body().open(request.file.c_str(), beast::file_mode::write, error);
			if (error)
				throw HttpError(507, "cannot write: " + error.message());
			co_await http::async_read(stream, connection.buffer, body, asio::redirect_error(asio::use_awaitable, error));
		} else {
			http::request_parser<http::string_body> body(std::move(header));
			body.body_limit(limit);
			co_await http::async_read(stream, connection.buffer, body, asio::redirect_error(asio::use_awaitable, error));
			request.body = std::move(body.get().body());
		}
		if (error == http::error::body_limit)
			throw HttpError(413, "the body is longer than " + std::to_string(limit) + " bytes");
		if (error.category() == boost::system::generic_category() || error.category() == boost::system::system_category()) {
			if (error == boost::system::errc::no_space_on_device)
				throw HttpError(507, "no space left on the server");
		}
		if (error) {
			std::error_code ignored;
			if (!request.file.empty())
				std::filesystem::remove(request.file, ignored);
			co_return false;
		}
		body_read = true;
		lowest.expires_never();
		response = co_await route.handler(request);
	} catch (const HttpError& e) {
		response = error_response(e.status, e.what());
	} catch (const Error& e) {
		response = error_response(400, e.what());
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
	co_return co_await send(stream, response, version, keep && body_read, request.method == "HEAD");
}

} // namespace farm
