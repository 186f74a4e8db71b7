// SPDX-License-Identifier: AGPL-3.0-or-later
/// Answers on their way out: a body, a file, or a stream.
#ifndef FARM_HTTP_SEND_H
#define FARM_HTTP_SEND_H

#include "distribute/http/message.h"

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <nlohmann/json.hpp>

namespace farm {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Code = boost::system::error_code;

template <class Body> http::response<Body> head(const Response& from, unsigned version, bool keep) {
	http::response<Body> answer(static_cast<http::status>(from.status), version);
	answer.set(http::field::server, "bhfarm");
	answer.set(http::field::content_type, from.type);
	answer.set("X-Content-Type-Options", "nosniff"); // what strangers sent is what we say it is
	for (const auto& [name, value] : from.headers)
		answer.set(name, value);
	answer.keep_alive(keep);
	return answer;
}

inline Response error_response(int status, const std::string& what) {
	Response response;
	response.status = status;
	response.body = nlohmann::json{{"error", what}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
	return response;
}

/// Each piece a chunk (RFC 9112, section 7.1).
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

/// Sends it; false when the connection is to be closed.
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

} // namespace farm
#endif
