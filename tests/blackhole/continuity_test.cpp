// SPDX-License-Identifier: AGPL-3.0-or-later
/// No tearing: through neighbouring rays every output moves as the exact one does, to the tolerance.
#include "extremes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <tuple>
#include <utility>
#include <vector>

using namespace blackhole;
using extremes::Ray;

namespace {

constexpr int steps = 10000;

struct Output {
	Vec3 end, tangent, exact_end, exact_tangent;
	double swept, exact_swept, radius;
	bool escaped, near;
	std::vector<Vec3> chords;
};

Output trace(const Ray& ray, Path& path) {
	Output o;
	EXPECT_TRUE(path.solve(ray.x, ray.d, ray.settings)) << ray.text();
	o.escaped = path.outcome() == Outcome::escaped;
	o.near = std::fabs(path.orbit().h / critical_b - 1) < 1e-3;
	o.end = path.end();
	o.tangent = path.end_tangent();
	o.swept = path.swept();
	o.radius = length(o.end);
	const Exact_Orbit exact(ray.x, ray.d);
	o.exact_swept = exact.end(ray.settings.effect_radius);
	if (exact.radial()) { // nothing to compare with: a straight line
		o.exact_end = o.end;
		o.exact_tangent = o.tangent;
	}
	const auto s = exact.at(o.exact_swept);
	const Vec3 out = std::cos(o.exact_swept) * exact.e1() + std::sin(o.exact_swept) * exact.e2();
	const Vec3 across = std::cos(o.exact_swept) * exact.e2() - std::sin(o.exact_swept) * exact.e1();
	if (!exact.radial()) {
		o.exact_end = o.radius * out;
		o.exact_tangent = unit(-s.du * out + s.u * across);
	}
	Chords chords(path, ray.settings.tolerance, ray.ramp);
	Chord c;
	while (chords.next(c))
		o.chords.push_back(c.to);
	return o;
}

struct Jumps {
	double direction = 0, place = 0, swept = 0; // over the tolerance
	double chord = 0; // what is left of the largest moves of chords' ends between neighbours 65536 times nearer
	int number = 0, compared = 0, changes = 0, near = 0;
};

// The largest move of a chord's end, over its radius; negative where the numbers of chords differ.
double moved(const Output& a, const Output& b) {
	if (a.chords.size() != b.chords.size())
		return -1;
	double most = 0;
	for (std::size_t j = 0; j < a.chords.size(); j++)
		most = std::max(most, length(a.chords[j] - b.chords[j]) / length(a.chords[j]));
	return most;
}

int more(const Output& a, const Output& b) { return std::abs(int(a.chords.size()) - int(b.chords.size())); }

// Between neighbours where chords' ends moved: follows the half with the larger move, sixteen times. What is smooth moves 65536
// times less in the end, a cube root (an end that runs off) still 40 times; a tear as much as before. Returns the share left.
template <typename Sweep> double tear(Sweep at, double t0, double t1, Path& path) {
	Output a = trace(at(t0), path), b = trace(at(t1), path);
	const double first = moved(a, b);
	double left = first;
	for (int i = 0; i < 16; i++) {
		Output m = trace(at(0.5 * (t0 + t1)), path);
		const double one = moved(a, m), two = moved(m, b);
		if (one < 0 || two < 0)
			return 0; // a chord came and went between
		if (one > two)
			t1 = 0.5 * (t0 + t1), b = std::move(m), left = one;
		else
			t0 = 0.5 * (t0 + t1), a = std::move(m), left = two;
	}
	return left < 1e-9 ? 0 : left / first; // rounding
}

// Likewise where the number of chords changes by more than one: it is one at a time, looked at closely enough. Down to 2e-10 of a
// neighbour's distance, where two chords may end in the same rounding.
template <typename Sweep> int step_of_number(Sweep at, double t0, double t1, Path& path) {
	Output a = trace(at(t0), path), b = trace(at(t1), path);
	for (int i = 0; i < 32 && more(a, b) > 1; i++) {
		Output m = trace(at(0.5 * (t0 + t1)), path);
		if (more(a, m) > more(m, b))
			t1 = 0.5 * (t0 + t1), b = std::move(m);
		else
			t0 = 0.5 * (t0 + t1), a = std::move(m);
	}
	return more(a, b);
}

// ray(t), t in [0, 1], in ten thousand steps. A jump is what an output moves from one ray to the next beyond what the exact one
// moves: it is the change of the output's error. Errors are smooth, of the size of the tolerance, and change over the whole
// sweep; where a picture would tear one changes at once. Chords' ends have no exact place: see tear().
template <typename Sweep> Jumps sweep(const char* name, Sweep at) {
	Jumps worst;
	Path path;
	Output a{}, b{};
	std::vector<std::pair<double, int>> moves;
	for (int i = 0; i <= steps; i++) {
		const Ray ray = at(double(i) / steps);
		const double tolerance = ray.settings.tolerance;
		b = std::move(a);
		a = trace(ray, path);
		worst.near += a.near;
		if (i == 0 || a.near || b.near || a.escaped != b.escaped)
			continue;
		worst.compared++;
		const double size = a.radius * tolerance;
		worst.direction =
			std::max(worst.direction, length((a.tangent - b.tangent) - (a.exact_tangent - b.exact_tangent)) / tolerance);
		worst.place = std::max(worst.place, length((a.end - b.end) - (a.exact_end - b.exact_end)) / size);
		worst.swept = std::max(worst.swept, std::fabs((a.swept - b.swept) - (a.exact_swept - b.exact_swept)) / tolerance);
		const double move = moved(a, b);
		const int number = more(a, b);
		worst.changes += number != 0;
		worst.number =
			std::max(worst.number, number > 1 ? step_of_number(at, double(i - 1) / steps, double(i) / steps, path) : number);
		if (move > 0.1 * tolerance)
			moves.push_back({-move, i});
	}
	std::sort(moves.begin(), moves.end());
	for (std::size_t j = 0; j < std::min<std::size_t>(moves.size(), 100); j++) {
		const int i = moves[j].second;
		worst.chord = std::max(worst.chord, tear(at, double(i - 1) / steps, double(i) / steps, path));
	}
	std::printf(
		"[ continuity ] %-16s %5d pairs (%d rays within 0.1 %% of b_c): jumps of direction %.4f, place %.4f, swept %.4f of the "
		"tolerance; chords' ends %.4f (%zu moves looked at); their number by %d at most, %d times\n",
		name, worst.compared, worst.near, worst.direction, worst.place, worst.swept, worst.chord,
		std::min<std::size_t>(moves.size(), 100), worst.number, worst.changes);
	return worst;
}

void expect_no_tear(const Jumps& j) {
	// A tear is a jump by an error, 0.1 to 0.5 of the tolerance; what is smooth moves by a ten-thousandth of its range, more
	// where b runs through the edge of the band in few steps (from 200 at all angles: 0.04).
	EXPECT_LT(j.direction, 0.06);
	EXPECT_LT(j.place, 0.06);
	EXPECT_LT(j.swept, 0.06);
	EXPECT_LE(j.number, 1);
	// All of it where there is a tear.
	EXPECT_LT(j.chord, 0.1);
	EXPECT_GT(j.compared, steps / 2);
}

Ray from(double r, double a, double R, const Settings& s) {
	return {{r, 0, 0}, {std::cos(a), std::sin(a), 0}, {R, s.tolerance, s.method}};
}
double angle(double r, double b) { return std::acos(-1.0) - std::asin(b / r / std::sqrt(1 + b * b / (r * r * r))); }

} // namespace

class Continuity : public testing::TestWithParam<std::tuple<Method, double>> {};

TEST_P(Continuity, OfImpactParameters) {
	const Settings settings{0, std::get<1>(GetParam()), std::get<0>(GetParam())};
	for (double r : {1000.0, 30.0})
		expect_no_tear(
			sweep("b from 2.602 to 22", [=](double t) { return from(r, angle(r, 2.602 + 19.4 * t * t), 1000, settings); }));
	expect_no_tear(sweep("b from 0 to 2.59", [=](double t) { return from(30, angle(30, 2.59 * t), 1000, settings); }));
}

TEST_P(Continuity, OfTheStartRadius) {
	const Settings settings{0, std::get<1>(GetParam()), std::get<0>(GetParam())};
	for (double a : {0.3, 1.5, 2.4})
		expect_no_tear(sweep("r from 1.02 to 41", [=](double t) { return from(1.02 + 40 * t * t, a, 1000, settings); }));
}

TEST_P(Continuity, OfTheCamerasAngle) {
	const Settings settings{0, std::get<1>(GetParam()), std::get<0>(GetParam())};
	for (double r : {1.2, 1.5, 4.0, 200.0})
		expect_no_tear(sweep("all angles", [=](double t) { return from(r, std::acos(-1.0) * t, 1000, settings); }));
}

TEST_P(Continuity, OfTheEffectRadius) {
	const Settings settings{0, std::get<1>(GetParam()), std::get<0>(GetParam())};
	for (double a : {0.7, 2.2})
		expect_no_tear(sweep("R from 4 to 1000", [=](double t) { return from(4, a, 4 * std::pow(250, t), settings); }));
	expect_no_tear(sweep("starts on it", [=](double t) {
		const double R = 4 * std::pow(250, t);
		return from(R, angle(R, 3.5), R, settings);
	}));
}

INSTANTIATE_TEST_SUITE_P(To, Continuity,
	testing::Combine(testing::Values(Method::rk4, Method::dopri5, Method::exact), testing::Values(0.1, 1e-2, 1e-4)));
