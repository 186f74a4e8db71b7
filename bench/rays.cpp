// SPDX-License-Identifier: AGPL-3.0-or-later
/// Measures codes on the same rays for bench/rays, which knows how to read this:
///
///   rays time R0 SIZE ROUNDS [all]  one CSV line for each code and setting; all: each of GYOTO's that was tried too
///   rays count R0 SIZE CODE...      each once, under callgrind, which dumps its counts after each
///
/// SIZE x SIZE pinhole rays of a static observer R0 Rs from the hole, nowhere special on GYOTO's sphere, the hole in the middle
/// of the picture, whose half width is 6 b_c as flat space would have it or 45 degrees. The exact answers are
/// tests/blackhole/oracle's.
#include "rays.h"

#include "blackhole/oracle.h"
#include "blackhole/orbit.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#define CALLGRIND_DUMP_STATS
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>

using namespace bench;

namespace {

constexpr double theta = 1.2, phi = 0.7;

std::vector<Ray> grid(double r, int size) {
	const double half = std::min(1.0, 6 * blackhole::critical_b / r);
	const double st = std::sin(theta), ct = std::cos(theta), sp = std::sin(phi), cp = std::cos(phi);
	const Vec3 er{st * cp, st * sp, ct}, et{ct * cp, ct * sp, -st}, ep{-sp, cp, 0};
	std::vector<Ray> rays;
	for (int j = 0; j < size; j++)
		for (int i = 0; i < size; i++) {
			const double x = half * ((2 * i + 1.0) / size - 1), y = half * ((2 * j + 1.0) / size - 1),
						 w = std::sqrt(1 + x * x + y * y);
			const double n[3] = {-1 / w, y / w, x / w};
			Ray ray;
			ray.x = r * er;
			ray.d = n[0] * std::sqrt(1 - 1 / r) * er + n[1] * et + n[2] * ep;
			gyoto_ray(ray, r, theta, phi, n);
			rays.push_back(ray);
		}
	gyoto_times(rays);
	return rays;
}

void exact(std::vector<Ray>& rays) {
	for (Ray& ray : rays) {
		Vec3 at;
		ray.captured = !oracle::exit_direction(ray.x, ray.d, far, ray.direction, at, &ray.b);
	}
}

std::unique_ptr<Code> code(const std::string& name) {
	std::unique_ptr<Code> c = our_code(name);
	if (!c)
		c = gyoto_code(name);
	if (!c) {
		std::fprintf(stderr, "rays: no code '%s'\n", name.c_str());
		std::exit(2);
	}
	return c;
}

double now() {
	timespec t;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
	return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Row {
	std::string label, name;
	std::unique_ptr<Code> code;
	std::vector<double> us;
	double median = 0, p99 = 0, max = 0, points = 0, max_clear = 0;
	unsigned wrong = 0;

	Row(std::string l, std::string n) : label(std::move(l)), name(std::move(n)), code(::code(name)) {}
	double time() const {
		std::vector<double> sorted = us;
		std::sort(sorted.begin(), sorted.end());
		return sorted[sorted.size() / 2];
	}
};

// Microseconds of this thread for each ray, over a twentieth of a second at least.
void clock_row(Row& row, const std::vector<Ray>& rays, std::vector<Answer>& answers) {
	const double start = now();
	double spent = 0;
	int passes = 0;
	do {
		row.code->trace(rays, answers);
		passes++;
		spent = now() - start;
	} while (spent < 0.05);
	row.us.push_back(spent / passes / double(rays.size()) * 1e6);
}

void judge(Row& row, const std::vector<Ray>& rays, const std::vector<Answer>& answers) {
	std::vector<double> errors;
	for (std::size_t i = 0; i < rays.size(); i++) {
		const Answer& a = answers[i];
		row.points += a.points / double(rays.size());
		if (a.failed || a.captured != rays[i].captured) {
			row.wrong++;
			continue;
		}
		if (a.captured)
			continue;
		Vec3 truth = rays[i].direction, at;
		if (a.r != far) // GYOTO's last step ends where it ends
			oracle::exit_direction(rays[i].x, rays[i].d, a.r, truth, at);
		errors.push_back(2 * std::asin(std::min(1.0, length(a.direction - truth) / 2)));
		if (std::fabs(rays[i].b / blackhole::critical_b - 1) > 0.01)
			row.max_clear = std::max(row.max_clear, errors.back());
	}
	if (errors.empty())
		return;
	std::sort(errors.begin(), errors.end());
	row.median = errors[errors.size() / 2];
	row.p99 = errors[errors.size() * 99 / 100];
	row.max = errors.back();
}

Row measured(const char* label, const std::string& name, const std::vector<Ray>& rays, std::vector<Answer>& answers) {
	Row row(label, name);
	clock_row(row, rays, answers);
	judge(row, rays, answers);
	return row;
}

bool no_worse(const Row& a, const Row& b) { return a.median <= b.median && a.max <= b.max && a.wrong <= b.wrong; }

std::string words(const char* format, const char* word, double number, double second = 0) {
	char text[100];
	std::snprintf(text, sizeof text, format, word, number, second);
	return text;
}

void print(const Row& row, double r, double nearest) {
	std::printf("%g,%s,%s,%.4g,%.2g,%.2g,%.2g,%.2g,%.2g,%u,%.1f\n", r, row.label.c_str(), row.name.c_str(), row.time(),
		row.median, row.p99, row.max, row.max_clear, nearest, row.wrong, row.points);
}

int time_all(double r, int size, int rounds, bool all) {
	std::vector<Ray> rays = grid(r, size);
	exact(rays);
	std::vector<Answer> answers(rays.size());
	double nearest = 1e300;
	for (const Ray& ray : rays)
		nearest = std::min(nearest, std::fabs(ray.b / blackhole::critical_b - 1));

	std::vector<Row> rows;
	auto add = [&](Row row) {
		row.us.clear();
		rows.push_back(std::move(row));
	};
	const char* standard = "fehlberg78 1e-06 0.01"; // GyotoDefs.h's
	Row theirs = measured("GYOTO default", std::string("gyoto ") + standard, rays, answers);

	// Its best: the fastest that is no worse than its default in median, max and rays that end on the wrong side. Tried from the
	// fastest on, by a sixteenth of the rays, so that few need be judged.
	std::vector<Ray> some;
	for (std::size_t i = 0; i < rays.size(); i++)
		if (i % 4 == 1 && i / std::size_t(size) % 4 == 1)
			some.push_back(rays[i]);
	std::vector<Row> tried;
	for (const char* integrator : {"fehlberg78", "dopri5", "cash_karp54", "cash_karp54_classic"})
		for (double tolerance = 1e-4; tolerance > 0.9e-9; tolerance /= 10)
			for (double step : {0.01, 1.0}) {
				tried.emplace_back("GYOTO tried", words("gyoto %s %.0e %g", integrator, tolerance, step));
				clock_row(tried.back(), some, answers);
			}
	std::sort(tried.begin(), tried.end(), [](const Row& p, const Row& q) { return p.us[0] < q.us[0]; });
	std::string best;
	for (const Row& fast : tried) {
		if (!best.empty() && !all)
			break;
		const Row row = measured("GYOTO tried", fast.name, rays, answers);
		if (all)
			print(row, r, nearest);
		if (best.empty() && no_worse(row, theirs))
			best = row.name;
	}
	// Ours as good as its default: the largest tolerance 1, 2 or 5 times a power of ten that is no worse in the same.
	const auto as_good = [&](const std::string& kind) {
		for (int k = 2; k < 10; k++)
			for (int digit : {5, 2, 1}) {
				const std::string name = kind + words(" %.0e", "", digit * std::pow(10., -k));
				if (no_worse(measured("", name, rays, answers), theirs))
					return name;
			}
		return std::string();
	};
	const std::string nodes = as_good("nodes"), polyline = as_good("polyline");

	add(std::move(theirs));
	add(measured("GYOTO default with points", std::string("gyoto-points ") + standard, rays, answers));
	add(measured("GYOTO best", best, rays, answers));
	add(measured("closed form", "escape", rays, answers));
	for (const char* t : {"1e-02", "1e-03", "1e-04", "1e-06", "1e-08"})
		add(measured("path's direction", std::string("path ") + t, rays, answers));
	for (const char* t : {"1e-03", "1e-04"})
		add(measured("polyline", std::string("polyline ") + t, rays, answers));
	if (!nodes.empty())
		add(measured("nodes as good as GYOTO", nodes, rays, answers));
	if (!polyline.empty())
		add(measured("polyline as good as GYOTO", polyline, rays, answers));

	for (int i = 0; i < rounds; i++)
		for (Row& row : rows)
			clock_row(row, rays, answers);
	for (const Row& row : rows)
		print(row, r, nearest);
	return 0;
}

int count_all(double r, int size, int n, char** names) {
	const std::vector<Ray> rays = grid(r, size);
	std::vector<Answer> answers(rays.size());
	for (int i = 0; i < n; i++) {
		const std::unique_ptr<Code> c = code(names[i]);
		c->trace(std::vector<Ray>(rays.begin(), rays.begin() + 9), answers); // symbols are looked up, memory is there
		CALLGRIND_START_INSTRUMENTATION;
		c->trace(rays, answers);
		CALLGRIND_STOP_INSTRUMENTATION;
		CALLGRIND_DUMP_STATS;
	}
	return 0;
}

} // namespace

int main(int count, char** argument) {
	try {
		gyoto_start();
		if (count >= 5 && !std::strcmp(argument[1], "time"))
			return time_all(std::atof(argument[2]), std::atoi(argument[3]), std::atoi(argument[4]), count > 5);
		if (count >= 5 && !std::strcmp(argument[1], "count"))
			return count_all(std::atof(argument[2]), std::atoi(argument[3]), count - 4, argument + 4);
	} catch (std::exception& e) {
		std::fprintf(stderr, "rays: %s\n", e.what());
		return 1;
	}
	std::fprintf(stderr, "rays time R0 SIZE ROUNDS [all] | rays count R0 SIZE CODE...\n");
	return 2;
}
