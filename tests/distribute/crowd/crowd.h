// SPDX-License-Identifier: AGPL-3.0-or-later
/// Workers that render nothing: for what they ask of a server, and how long it lets them wait. Many in one process and one
/// thread, so that they leave the machine to the server; each has the connections that a real one with one slot has.
#ifndef FARM_CROWD_H
#define FARM_CROWD_H

#include <utility> // Boost 1.74's awaitable.hpp needs it

#include <boost/asio.hpp>

#include <string>
#include <vector>

namespace crowd {

namespace asio = boost::asio;
template <class T> using Awaitable = asio::awaitable<T>;
using Clock = std::chrono::steady_clock;

struct Settings {
	std::string host, port, token;
	int workers = 200;
	double strip_seconds = 10; ///< what a strip takes, a tenth more or less
	double seconds = 60;       ///< how long all of it goes on
	double ramp = 5;           ///< the workers come within so many seconds
	bool lean = false;         ///< a worker keeps one connection open, not three
	std::string strip;         ///< the picture that each sends
	std::string strip_hash;
	long job = 0;
};

/// Seconds that something took, each time.
struct Times {
	std::vector<double> all;
	void add(Clock::time_point since) { all.push_back(std::chrono::duration<double>(Clock::now() - since).count()); }
	/// The value below which so much of them lies; 0 if there are none.
	double part(double fraction);
};

struct Figures {
	double busy = 0, idle = 0; ///< seconds of slots, all together, after each one's first strip
	long sent = 0, accepted = 0, empty = 0, errors = 0;
	Times takes, uploads, beats, status;
	std::string error; ///< the first
};

/// One connection, kept open, opened again when it broke.
class Line {
public:
	Line(asio::io_context& context, const Settings& settings) : socket(context), set(settings) {}
	/// The status, 0 if the connection broke; the answer's body is in `answer`.
	Awaitable<int> ask(const char* method, std::string path, std::string_view body);
	void close();
	std::string answer;

private:
	Awaitable<int> once(const char* method, const std::string& path, std::string_view body);
	asio::ip::tcp::socket socket;
	const Settings& set;
	std::string buffer;
};

/// The number after "KEY": in a JSON text; -1 if there is none.
long number_in(const std::string& text, const std::string& key);
/// A PNG of this size, as compressible as a rendered one, of rows that a strip has.
std::string make_strip(int width, int rows);
/// Bundle and job for such strips; returns the job's number. Throws std::runtime_error.
Awaitable<long> submit(Line& line, int width, int rows, int strips_per_frame, int frames);

} // namespace crowd
#endif
