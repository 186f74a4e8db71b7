// SPDX-License-Identifier: AGPL-3.0-or-later
// As little HTTP/1.1 as the answers of a bhfarm server need.
#include "tests/distribute/crowd/crowd.h"

#include <algorithm>
#include <cstdlib>

namespace crowd {
namespace {

using Code = boost::system::error_code;

/// The length that a head announces; 0 if it says none.
size_t length_of(std::string_view head) {
	const size_t at = head.find("Content-Length: ");
	return at == std::string_view::npos ? 0 : std::strtoul(head.data() + at + 16, nullptr, 10);
}

} // namespace

Awaitable<int> Line::once(const char* method, const std::string& path, std::string_view body) {
	Code error;
	const auto into = [&error] { return asio::redirect_error(asio::use_awaitable, error); };
	if (!socket.is_open()) {
		buffer.clear();
		const asio::ip::tcp::endpoint place(asio::ip::make_address(set.host), static_cast<unsigned short>(std::stoi(set.port)));
		// One address has no more than some 28,000 ports for connections to one server.
		if (place.address().is_loopback() && place.address().is_v4()) {
			static unsigned count = 0;
			socket.open(place.protocol());
			socket.bind({asio::ip::make_address_v4(0x7f000002 + count++ % 16), 0});
		}
		co_await socket.async_connect(place, into());
		if (error)
			co_return 0;
		socket.set_option(asio::ip::tcp::no_delay(true));
	}
	std::string head = std::string(method) + " " + path + " HTTP/1.1\r\nHost: " + set.host +
					   "\r\nContent-Length: " + std::to_string(body.size());
	if (!set.token.empty())
		head += "\r\nAuthorization: Bearer " + set.token;
	head += "\r\n\r\n";
	const std::array<asio::const_buffer, 2> out{asio::buffer(head), asio::buffer(body)};
	co_await asio::async_write(socket, out, into());
	if (error)
		co_return 0;
	const size_t headed = co_await asio::async_read_until(socket, asio::dynamic_buffer(buffer), "\r\n\r\n", into());
	if (error || buffer.size() < 12)
		co_return 0;
	const size_t length = length_of(std::string_view(buffer).substr(0, headed));
	const int status = std::atoi(buffer.c_str() + 9);
	if (buffer.size() < headed + length)
		co_await asio::async_read(
			socket, asio::dynamic_buffer(buffer), asio::transfer_exactly(headed + length - buffer.size()), into());
	if (error)
		co_return 0;
	answer = buffer.substr(headed, length);
	buffer.erase(0, headed + length);
	co_return status;
}

// A connection that was idle for long may have been closed by the server: then once more.
Awaitable<int> Line::ask(const char* method, std::string path, std::string_view body) {
	for (int tries = 0;; ++tries) {
		const bool fresh = !socket.is_open();
		if (const int status = co_await once(method, path, body); status)
			co_return status;
		close();
		if (fresh || tries == 1)
			co_return 0;
	}
}

void Line::close() {
	Code ignored;
	socket.close(ignored);
}

long number_in(const std::string& text, const std::string& key) {
	const size_t at = text.find("\"" + key + "\":");
	return at == std::string::npos ? -1 : std::strtol(text.c_str() + at + key.size() + 3, nullptr, 10);
}

double Times::part(double fraction) {
	if (all.empty())
		return 0;
	const auto at = static_cast<size_t>(fraction * static_cast<double>(all.size() - 1));
	std::nth_element(all.begin(), all.begin() + static_cast<long>(at), all.end());
	return all[at];
}

} // namespace crowd
