// SPDX-License-Identifier: AGPL-3.0-or-later
/// As extremes_test.cpp, with a hundred million rays in slices of a hundred thousand, and a tenth as many by charts. Each
/// finished slice is a few lines in a file, and what is there is not done again: a run can be stopped and taken up.
/// docs/stability.md has the figures.
#include "extremes.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

using namespace extremes;

namespace {

constexpr long slice_rays = 100000;

const char* const help = R"(usage: extremes_long [--rays N] [--seconds S] [--threads T] [--state FILE]
Checks N rays (100000000) at the extremes, for S seconds at most (no limit), with T threads (1). Finished slices are kept in FILE
(extremes.state) and not done again. Prints the figures of all that is in FILE; exit code 1 if a ray failed, 2 for bad usage.
)";

struct Slice {
	Figures figures[kinds];
	Charted_Figures charted;
	std::vector<std::string> failures;
};

// rays: so many of all kinds together. The number says which.
Slice run(long number, long rays) {
	Slice slice;
	blackhole::Path path;
	for (int kind = 0; kind < kinds; kind++) {
		std::mt19937_64 random(std::uint64_t(1000 * number + kind + 1));
		for (long i = 0; slice.figures[kind].rays < rays / kinds && i < 100 * rays; i++) {
			const Ray ray = generate(Kind(kind), random);
			if (!allowed(ray))
				continue;
			const std::string what = check(ray, i % 16 == 0, path, slice.figures[kind]);
			if (!what.empty() && slice.failures.size() < 20)
				slice.failures.push_back(std::string(kind_names[kind]) + ": " + what + ": " + ray.text());
		}
	}
	// One hole's charts a slice, of any settings: a tenth as many rays as the slice has.
	std::mt19937_64 random(std::uint64_t(1000 * number));
	std::uniform_real_distribution<double> u(0, 1);
	const blackhole::Settings settings{u(random) < 0.2 ? 1.5 + std::pow(10, -8 * u(random)) : 1.5 * std::pow(10, 15 * u(random)),
		blackhole::Atlas::finest * std::pow(2000, u(random)),
		u(random) < 0.5 ? blackhole::Method::rk4 : blackhole::Method::dopri5};
	const blackhole::Atlas atlas(settings);
	for (long i = 0; slice.charted.rays < rays / 10 && i < rays; i++) {
		Ray ray;
		if (!generate(int(i % (kinds + 1)), settings, i % 4 == 0, random, ray))
			continue;
		const std::string what = check(ray, atlas, slice.charted);
		if (!what.empty() && slice.failures.size() < 20)
			slice.failures.push_back("charted: " + what + ": " + ray.text());
	}
	return slice;
}

// What an engine is known by: what it makes of some rays. A file of another one must not be taken up.
std::string engine() {
	const Slice slice = run(-1, 2000);
	Figures all;
	for (const Figures& f : slice.figures)
		all.add(f);
	return "engine " + all.line() + " " + slice.charted.line();
}

double number(const char* name, const char* text) {
	char* end;
	const double value = text ? std::strtod(text, &end) : 0;
	if (!text || end == text || *end || !(value > 0)) {
		std::fprintf(stderr, "extremes_long: %s %s: must be a number above 0\n", name, text ? text : "");
		std::exit(2);
	}
	return value;
}

} // namespace

int main(int argc, char** argv) {
	double rays = 1e8, seconds = 1e30;
	int threads = 1;
	std::string file = "extremes.state";
	for (int i = 1; i < argc; i += 2) {
		const std::string name = argv[i];
		const char* value = i + 1 < argc ? argv[i + 1] : nullptr;
		if (name == "--rays")
			rays = number("--rays", value);
		else if (name == "--seconds")
			seconds = number("--seconds", value);
		else if (name == "--threads")
			threads = int(number("--threads", value));
		else if (name == "--state" && value)
			file = value;
		else {
			const bool asked = name == "--help";
			std::fputs(help, asked ? stdout : stderr);
			return asked ? 0 : 2;
		}
	}

	const long slices = long(std::ceil(rays / slice_rays));
	const std::string mark = engine();
	std::set<long> done;
	Figures figures[kinds];
	Charted_Figures charted;
	long failures = 0;
	{
		std::ifstream in(file);
		std::string line;
		if (std::getline(in, line) && line != mark) {
			std::fprintf(stderr, "extremes_long: %s is of another engine; remove it to begin anew\n", file.c_str());
			return 2;
		}
		std::vector<Figures> part;
		Charted_Figures part_charted;
		while (std::getline(in, line)) { // a slice counts when its last line is there
			std::istringstream words(line);
			std::string word;
			long slice;
			Figures f;
			if (!(words >> word))
				continue;
			if (word == "FAILED") {
				std::printf("%s\n", line.c_str());
				failures++;
			} else if (word == "kind" && f.read(words))
				part.push_back(f);
			else if (word == "charted" && part_charted.read(words))
				continue;
			else if (word == "slice" && words >> slice && part.size() == kinds) {
				if (done.insert(slice).second) {
					for (int k = 0; k < kinds; k++)
						figures[k].add(part[std::size_t(k)]);
					charted.add(part_charted);
				}
				part.clear();
			} else
				part.clear();
		}
	}
	std::ofstream out(file, std::ios::app);
	if (out.tellp() == 0)
		out << mark << "\n";
	if (!out.flush()) {
		std::fprintf(stderr, "extremes_long: %s: cannot write there\n", file.c_str());
		return 2;
	}

	const auto start = std::chrono::steady_clock::now();
	const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
	std::atomic<long> next{0};
	long made = 0;
	std::mutex mutex;
	const auto work = [&] {
		for (long i; passed() < seconds && (i = next++) < slices;) {
			{
				std::lock_guard<std::mutex> lock(mutex);
				if (done.count(i))
					continue;
			}
			const Slice slice = run(i, slice_rays);
			std::lock_guard<std::mutex> lock(mutex);
			for (const std::string& f : slice.failures) {
				out << "FAILED " << f << "\n";
				std::printf("FAILED %s\n", f.c_str());
			}
			for (int k = 0; k < kinds; k++) {
				out << "kind " << slice.figures[k].line() << "\n";
				figures[k].add(slice.figures[k]);
			}
			out << "charted " << slice.charted.line() << "\n";
			charted.add(slice.charted);
			out << "slice " << i << std::endl;
			failures += long(slice.failures.size());
			done.insert(i);
			made++;
			if (isatty(2)) {
				const double left = passed() / double(made) * double(slices - long(done.size()));
				std::fprintf(stderr, "\r%zu of %ld slices, %.0f min left  ", done.size(), slices, left / 60);
			}
		}
	};
	std::vector<std::thread> crew;
	for (int t = 1; t < threads; t++)
		crew.emplace_back(work);
	work();
	for (std::thread& t : crew)
		t.join();
	if (isatty(2))
		std::fputc('\n', stderr);

	Figures all;
	for (int kind = 0; kind < kinds; kind++) {
		figures[kind].print(kind_names[kind]);
		all.add(figures[kind]);
	}
	all.print("all");
	charted.print("charted");
	std::printf("[ extremes ] %zu of %ld slices done (%ld in this run, %.0f s), %ld rays, %ld failures\n", done.size(), slices,
		made, passed(), all.rays, failures);
	return failures == 0 && all.rays > 0 ? 0 : 1;
}
