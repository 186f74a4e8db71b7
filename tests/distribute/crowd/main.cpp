// SPDX-License-Identifier: AGPL-3.0-or-later
// farm_crowd: a server under the load of many simulated workers. Prints what they saw as one JSON object.
#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"
#include "tests/distribute/crowd/crowd.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <random>
#include <sys/resource.h>

namespace {

using namespace crowd;

const std::vector<farm::Option> options = {
	{"--server", "HOST:PORT", "an address, not a name", ""},
	{"--token-file", "FILE", "", ""},
	{"--workers", "N", "of one slot each", "200"},
	{"--strip-ms", "MS", "what a strip takes, a tenth more or less", "10000"},
	{"--seconds", "S", "how long it goes on", "60"},
	{"--strips", "N", "it ends when so many were taken in, if that is sooner; 0: it does not", "0"},
	{"--ramp", "S", "the workers come within so many seconds", "5"},
	{"--lean", "",
		"a worker keeps one connection, not three: heartbeats go where strips are asked for, and the one for sending closes", ""},
	{"--width", "PIXELS", "of a strip", "1280"},
	{"--rows", "ROWS", "of a strip", "128"},
	{"--status-ms", "MS", "how often the job's status is asked for", "500"},
};

class Crowd {
public:
	Crowd(asio::io_context& c, const Settings& s) : context(c), set(s), until(Clock::now() + span(s.seconds)) {}
	Figures figures;

	Awaitable<void> work(int number) {
		asio::steady_timer timer(context);
		std::minstd_rand chance(static_cast<unsigned>(number) + 1);
		std::uniform_real_distribution<double> jitter(0.9, 1.1), come(0, set.ramp);
		co_await sleep(timer, come(chance));
		const auto self = std::make_shared<Self>(context, set, number);
		const std::string hello = R"({"id":")" + self->id + R"(","name":"crowd","slots":1,"povray":"none","probe":"none"})";
		good(co_await self->taking.ask("POST", "/v1/workers", hello) == 201, self->taking);
		spawn(beat(self));
		const std::string path = "/v1/workers/" + self->id + "/take", wait = R"({"wait":30})";
		for (bool first = true; Clock::now() < until;) {
			const auto asked = Clock::now();
			while (self->beating) // on the same connection
				co_await sleep(timer, 0.001);
			self->polling = true;
			const int status = co_await self->taking.ask("POST", path, wait);
			self->polling = false;
			if (Clock::now() >= until)
				break;
			if (!first)
				figures.idle += std::chrono::duration<double>(Clock::now() - asked).count();
			if (status == 204) {
				++figures.empty;
				continue;
			}
			if (!good(status == 200, self->taking)) {
				co_await sleep(timer, 1);
				continue;
			}
			figures.takes.add(asked);
			const long lease = number_in(self->taking.answer, "lease");
			self->lease = lease;
			const auto start = Clock::now();
			co_await sleep(timer, set.strip_seconds * jitter(chance));
			first = false;
			figures.busy += std::chrono::duration<double>(Clock::now() - start).count();
			while (self->sending && Clock::now() < until) { // one is sent while one is rendered, as by the real ones
				const auto late = Clock::now();
				co_await sleep(timer, 0.01);
				figures.idle += std::chrono::duration<double>(Clock::now() - late).count();
			}
			self->sending = true;
			spawn(send(self, lease));
		}
	}

	Awaitable<void> ask_status(double every) {
		asio::steady_timer timer(context);
		Line line(context, set);
		co_await sleep(timer, set.ramp);
		while (Clock::now() < until) {
			const auto asked = Clock::now();
			if (!good(co_await line.ask("GET", "/v1/jobs/" + std::to_string(set.job), "") == 200, line))
				break;
			figures.status.add(asked);
			co_await sleep(timer, every);
		}
	}

	void spawn(Awaitable<void> what) {
		asio::co_spawn(context, std::move(what), [](std::exception_ptr e) {
			if (e)
				std::rethrow_exception(e);
		});
	}

private:
	struct Self {
		Self(asio::io_context& c, const Settings& s, int number)
			: taking(c, s), delivering(c, s), touching(c, s), id("crowd-worker-" + std::to_string(number)) {}
		Line taking, delivering, touching;
		std::string id;
		long lease = 0;
		bool sending = false, polling = false, beating = false;
	};

	static Clock::duration span(double seconds) {
		return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
	}
	static Awaitable<void> sleep(asio::steady_timer& timer, double seconds) {
		timer.expires_after(span(seconds));
		co_await timer.async_wait(asio::use_awaitable);
	}
	bool good(bool is, const Line& line) {
		if (!is && Clock::now() < until && ++figures.errors == 1)
			figures.error = line.answer.empty() ? "no answer" : line.answer;
		return is;
	}
	Awaitable<void> send(std::shared_ptr<Self> self, long lease) {
		const auto start = Clock::now();
		const std::string path = "/v1/leases/" + std::to_string(lease) + "/strip?sha256=" + set.strip_hash + "&seconds=10";
		++figures.sent;
		if (good(co_await self->delivering.ask("PUT", path, set.strip) == 200, self->delivering)) {
			figures.uploads.add(start);
			figures.accepted += self->delivering.answer.find("true") != std::string::npos;
		}
		if (set.lean)
			self->delivering.close();
		self->sending = false;
	}
	Awaitable<void> beat(std::shared_ptr<Self> self) {
		asio::steady_timer timer(context);
		const std::string path = "/v1/workers/" + self->id + "/heartbeat";
		while (Clock::now() < until) {
			co_await sleep(timer, 5); // a quarter of the server's lease
			const std::string body = "{\"leases\":[" + (self->lease ? std::to_string(self->lease) : "") + "]}";
			if (set.lean && self->polling) // who asks is heard
				continue;
			Line& line = set.lean ? self->taking : self->touching;
			const auto start = Clock::now();
			self->beating = set.lean;
			if (good(co_await line.ask("POST", path, body) == 200, line))
				figures.beats.add(start);
			self->beating = false;
		}
	}

	asio::io_context& context;
	const Settings& set;
	Clock::time_point until;
};

nlohmann::json summary(Times& times) {
	return {{"count", times.all.size()}, {"median", times.part(0.5)}, {"p99", times.part(0.99)}, {"most", times.part(1)}};
}

int run(const farm::Arguments& a) {
	rlimit descriptors{};
	getrlimit(RLIMIT_NOFILE, &descriptors);
	descriptors.rlim_cur = descriptors.rlim_max;
	setrlimit(RLIMIT_NOFILE, &descriptors);
	Settings set;
	const std::string& server = a.get("--server");
	set.host = server.substr(0, server.rfind(':'));
	set.port = server.substr(server.rfind(':') + 1);
	if (!a.get("--token-file").empty()) {
		const std::string token = farm::read_file(a.get("--token-file"));
		set.token = token.substr(0, token.find('\n'));
	}
	set.workers = static_cast<int>(a.number("--workers", 1, 100000));
	set.strip_seconds = 0.001 * static_cast<double>(a.number("--strip-ms", 1, 1000000));
	set.seconds = static_cast<double>(a.number("--seconds", 1, 100000));
	set.lean = a.has("--lean");
	set.ramp = static_cast<double>(a.number("--ramp", 0, 100000));
	const int width = static_cast<int>(a.number("--width", 1, 10000)), rows = static_cast<int>(a.number("--rows", 1, 10000));
	set.strip = make_strip(width, rows);
	set.strip_hash = farm::sha256(set.strip);
	constexpr int strips_per_frame = 8;
	// Twice as many as can be rendered, so that the end is not reached.
	const int enough = static_cast<int>(a.number("--strips", 0, 1000000));
	const double most = enough ? enough + 4 * set.workers : 2 * set.workers * (set.seconds / set.strip_seconds + 2);
	const int frames = static_cast<int>(most / strips_per_frame) + 1;

	asio::io_context context(1);
	std::unique_ptr<Crowd> crowd;
	const auto begin = [&]() -> Awaitable<void> {
		Line line(context, set);
		set.job = co_await submit(line, width, rows, strips_per_frame, frames);
		crowd = std::make_unique<Crowd>(context, set);
		for (int i = 0; i < set.workers; ++i)
			crowd->spawn(crowd->work(i));
		crowd->spawn(crowd->ask_status(0.001 * static_cast<double>(a.number("--status-ms", 1, 1000000))));
		const auto end = Clock::now() + std::chrono::duration<double>(set.seconds);
		asio::steady_timer timer(context);
		while (Clock::now() < end && (!enough || static_cast<int>(crowd->figures.accepted) < enough)) {
			timer.expires_after(std::chrono::milliseconds(20));
			co_await timer.async_wait(asio::use_awaitable);
		}
		context.stop();
	};
	asio::co_spawn(context, begin(), [](std::exception_ptr e) {
		if (e)
			std::rethrow_exception(e);
	});
	context.run();
	Figures& f = crowd->figures;
	rusage used{};
	getrusage(RUSAGE_SELF, &used);
	const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
	const nlohmann::json out{{"job", set.job}, {"workers", set.workers}, {"bytes", set.strip.size()},
		{"idle", f.busy + f.idle > 0 ? f.idle / (f.busy + f.idle) : 1}, {"sent", f.sent}, {"accepted", f.accepted},
		{"empty", f.empty}, {"errors", f.errors}, {"error", f.error}, {"take", summary(f.takes)}, {"upload", summary(f.uploads)},
		{"heartbeat", summary(f.beats)}, {"status", summary(f.status)}, {"cpu", seconds(used.ru_utime) + seconds(used.ru_stime)}};
	std::printf("%s\n", out.dump(1, '\t').c_str());
	std::fflush(stdout);
	std::_Exit(f.errors ? 1 : 0); // coroutines that wait are not worth taking apart
}

} // namespace

int main(int argc, char** argv) {
	farm::name_program("farm_crowd", false);
	try {
		return run(farm::Arguments({argv + 1, argv + argc}, options));
	} catch (const std::exception& e) {
		farm::say(e.what());
		return 2;
	}
}
