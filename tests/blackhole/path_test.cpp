// SPDX-License-Identifier: AGPL-3.0-or-later
/// Paths and chords against exact geodesics: direction at exit, distance of every chord, the tolerance's promise.
#include "blackhole/chords.h"
#include "blackhole/frames.h"
#include "blackhole/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <tuple>

using namespace blackhole;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double R = 10000; // the default

struct Worst {
	double direction = 0, distance = 0; // in units of the tolerance
	double drift = 0;
	int rays = 0, near_critical = 0;
};

// The distance from the path of points along every chord; the angle swept is followed from chord to chord.
void follow_chords(const Path& path, const oracle::Ray& exact, double r0, double tolerance, Worst& worst) {
	Chords chords(path, tolerance, false);
	Chord c;
	double phi = 0;
	int n = 0;
	Vec3 last_end = path.orbit().to_space(path.orbit().p);
	while (chords.next(c)) {
		ASSERT_EQ(length(c.from - last_end), 0) << "chords must join";
		last_end = c.to;
		// All of a chord's points, but of long chains only some chords: the oracle is slow.
		const bool look = n++ % std::max(1, int(3e-3 / std::sqrt(tolerance))) == 0 || tolerance > 1e-4;
		for (double t : {0.25, 0.5, 0.75, 1.0}) {
			const Vec3 q = c.from + t * (c.to - c.from);
			double at = std::atan2(q.y, q.x);
			while (at < phi - 3)
				at += 2 * pi;
			if (t == 1.0)
				phi = at;
			const double r = length(q);
			if (!look || r < 1.0001 || r > 0.999 * R || std::fabs(r - r0) < 1e-9)
				continue;
			worst.distance = std::max(worst.distance, double(exact.distance(r, at)) / r / tolerance);
		}
	}
	ASSERT_LT(length(last_end - path.end()), 1e-12 * R);
}

Worst measure(Method method, double r0, double tolerance, int rays, unsigned seed) {
	std::mt19937_64 random(seed);
	std::uniform_real_distribution<double> u(0, 1);
	const Settings settings{R, tolerance, method};
	Path path;
	Worst worst;
	for (int i = 0; i < rays; i++) {
		const double widest = r0 > 50 ? 8 / r0 : pi;
		const double a = pi - widest * u(random);
		const oracle::Ray exact(r0, a);
		const Vec3 x{r0, 0, 0}, d{std::cos(a), std::sin(a), 0};
		EXPECT_TRUE(path.solve(x, d, settings));
		EXPECT_EQ(path.outcome() == Outcome::escaped, exact.escapes());
		if (std::fabs(double(exact.b()) / critical_b - 1) < 1e-3) {
			worst.near_critical++;
			continue;
		}
		worst.rays++;
		EXPECT_FALSE(path.nudged());
		worst.drift = std::max(worst.drift, path.drift());
		follow_chords(path, exact, r0, tolerance, worst);
		Vec3 direction, position;
		if (oracle::exit_direction(x, d, R, direction, position)) {
			worst.direction = std::max(worst.direction, length(cross(direction, path.end_tangent())) / tolerance);
			EXPECT_LT(length(position - path.end()), tolerance * R);
			// The swept angle, turns and all, is the exact one.
			const double phi = double(exact.swept(R, exact.turns() ? 1 : 0));
			EXPECT_NEAR(path.swept(), phi, tolerance * 2);
		}
	}
	return worst;
}

} // namespace

class Tolerance : public testing::TestWithParam<std::tuple<Method, double>> {};

// The promise of physics.md, from starts far and near and on both sides of the photon sphere.
TEST_P(Tolerance, IsKept) {
	const auto [method, tolerance] = GetParam();
	for (double r0 : {999.0, 25.0, 7.5, 3.0, 1.6, 1.5, 1.2, 1.01}) {
		const Worst w = measure(method, r0, tolerance, tolerance < 1e-5 ? 80 : 200, 11);
		std::printf(
			"%-6s tolerance %.0e  r0 %-5g  direction %.3f  chords %.3f of it  (%d rays, %d within 0.1%% of b_c), drift %.1e\n",
			method_names[int(method)], tolerance, r0, w.direction, w.distance, w.rays, w.near_critical, w.drift);
		EXPECT_LT(w.direction, 1);
		EXPECT_LT(w.distance, 1);
		EXPECT_LT(w.drift, tolerance);
	}
}

INSTANTIATE_TEST_SUITE_P(From, Tolerance,
	testing::Combine(testing::Values(Method::rk4, Method::dopri5, Method::exact), testing::Values(1e-2, 1e-3, 1e-4, 1e-5, 1e-6)));

// Rays just outside the 0.1 % band are the hardest the promise covers.
TEST(Path, IsWithinToleranceAtTheEdgeOfTheBand) {
	for (double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
		for (double r0 : {999.0, 25.0, 3.0, 1.6}) {
			double worst = 0;
			for (double off = 1.001e-3; off < 0.02; off *= 1.15) {
				const double b = critical_b * (1 + off);
				const double s = b / r0 / std::sqrt(1 + b * b / (r0 * r0 * r0)), c = -std::sqrt(1 - s * s);
				if (!(s < 1))
					continue; // so wide a ray never comes this near
				const Vec3 x{r0, 0, 0}, d{c, s, 0};
				Path path;
				ASSERT_TRUE(path.solve(x, d, {R, tolerance, Method::rk4}));
				Vec3 direction, position;
				ASSERT_TRUE(oracle::exit_direction(x, d, R, direction, position));
				worst = std::max(worst, length(cross(direction, path.end_tangent())) / tolerance);
			}
			EXPECT_LT(worst, 1) << "tolerance " << tolerance << ", r0 " << r0;
		}
}

TEST(Path, RadialRaysStayOnTheirLine) {
	Path path;
	ASSERT_TRUE(path.solve({0, 20, 0}, {0, -1, 0}, {1000, 1e-4, Method::rk4}));
	EXPECT_EQ(path.outcome(), Outcome::captured);
	EXPECT_NEAR(length(path.end() - Vec3{0, 1, 0}), 0, 1e-14);
	EXPECT_EQ(path.swept(), 0);
	ASSERT_TRUE(path.solve({0, 20, 0}, {0, 1, 0}, {1000, 1e-4, Method::rk4}));
	EXPECT_NEAR(length(path.end() - Vec3{0, 1000, 0}), 0, 1e-9);
}

TEST(Path, FromInsideTheHorizon) {
	Path path;
	const Vec3 x{0.5, 0, 0}, d{std::cos(0.2), std::sin(0.2), 0};
	ASSERT_TRUE(path.solve(x, d, {1000, 1e-5, Method::rk4}));
	EXPECT_TRUE(path.started_inside());
	EXPECT_EQ(path.outcome(), Outcome::escaped);
	Chords chords(path, 1e-5, false);
	Chord c;
	ASSERT_TRUE(chords.next(c));
	EXPECT_NEAR(length(c.from), 1, 1e-9) << "nothing inside the horizon may be hit";
	Vec3 direction, position;
	ASSERT_TRUE(oracle::exit_direction(x, d, 1000, direction, position));
	EXPECT_LT(length(cross(direction, path.end_tangent())), 1e-5);
}

// Falling observers look from there; rays of little energy are the hardest.
TEST(Path, KeepsTheToleranceDeepInsideTheHorizon) {
	for (const Method method : {Method::rk4, Method::dopri5, Method::exact})
		for (double tolerance : {1e-2, 1e-4, 1e-6})
			for (double r : {0.9, 0.5, 0.1, 0.01, 1e-3})
				for (double part : {0.1, 0.5, 0.9, 0.99}) {
					const double s = part * std::sqrt(r);
					const Vec3 x{r, 0, 0}, d{std::sqrt(1 - s * s), s, 0};
					Path path;
					ASSERT_TRUE(path.solve(x, d, {1000, tolerance, method}));
					Vec3 direction, position;
					double b;
					const bool escapes = oracle::exit_direction(x, d, 1000, direction, position, &b);
					ASSERT_EQ(escapes, path.outcome() == Outcome::escaped);
					if (!escapes || std::fabs(b / critical_b - 1) < 1e-3)
						continue;
					EXPECT_LT(length(cross(direction, path.end_tangent())) / tolerance, 1)
						<< "r " << r << ", b " << b << ", tolerance " << tolerance;
				}
}

// Rays of next to no energy come out of the horizon by a hair and fall back: they end, and so do their chords.
TEST(Path, EndsForEveryDirectionAFallingObserverLooks) {
	for (const Method method : {Method::rk4, Method::dopri5, Method::exact})
		for (double tolerance : {1e-2, 1e-3, 1e-5})
			for (double r : {1.0, 0.999999, 0.999, 0.9, 0.5, 0.01})
				for (int i = 0; i < 2000; i++) {
					const double a = pi * (i + 0.5) / 2000;
					const Vec3 x{r, 0, 0};
					Vec3 d;
					if (!falling_to_coordinate(x, {std::cos(a), std::sin(a), 0}, 1000, d))
						continue;
					Path path;
					ASSERT_TRUE(path.solve(x, d, {1000, tolerance, method})) << r << " " << a;
					Chords chords(path, tolerance, false);
					Chord c;
					int n = 0;
					while (chords.next(c)) {
						ASSERT_LT(++n, 20000) << r << " " << a;
						ASSERT_GE(length(c.from), 1 - 1e-9);
					}
				}
}

// What light does forward it does backward: the path from the exit, reversed, comes back.
TEST(Path, IsReversible) {
	for (double a : {0.12, 0.2, 0.6, 1.5}) {
		const Vec3 x{25, 0, 0}, d{-std::cos(a), std::sin(a), 0};
		Path path;
		ASSERT_TRUE(path.solve(x, d, {25, 1e-6, Method::rk4}));
		ASSERT_EQ(path.outcome(), Outcome::escaped);
		const Vec3 from = path.end(), back = -path.end_tangent();
		ASSERT_TRUE(path.solve(from, back, {25, 1e-6, Method::rk4}));
		EXPECT_LT(length(path.end() - x), 25e-6);
		EXPECT_LT(length(path.end_tangent() + d), 2e-6);
	}
}

// Numbers follow the closed-form outcome however close b is to critical, and no ray is lost.
TEST(Path, FollowsTheOutcomeAtTheEdge) {
	Path path;
	for (const Method method : {Method::rk4, Method::dopri5, Method::exact})
		for (double tolerance : {1e-1, 1e-3, 1e-6})
			for (double off = 1e-3; off > 1e-17; off /= 3)
				for (double side : {-1.0, 1.0})
					for (double r0 : {1000.0, 10.0, 1.4}) {
						const double b = critical_b * (1 + side * off);
						const double s = b / r0 / std::sqrt(1 + b * b / (r0 * r0 * r0));
						const double c = std::sqrt(1 - s * s) * (r0 > 1.5 ? -1 : 1);
						ASSERT_TRUE(path.solve({r0, 0, 0}, {c, s, 0}, {1000, tolerance, method}))
							<< method_names[int(method)] << " " << tolerance << " " << side * off << " " << r0;
						ASSERT_LT(path.nodes().size(), 60000u);
					}
}

TEST(Chords, ARampStartsShort) {
	Path path;
	ASSERT_TRUE(path.solve({4, 0, 0}, {0, 1, 0}, {1000, 1e-3, Method::rk4}));
	Chord plain, ramp;
	Chords(path, 1e-3, false).next(plain);
	Chords(path, 1e-3, true).next(ramp);
	EXPECT_LT(length(ramp.to - ramp.from), length(plain.to - plain.from) / 50);
}

// What no method can do is said, soon, and not called something else.
TEST(Path, SaysThatItsStepsRanOut) {
	Path path;
	for (Method method : {Method::rk4, Method::dopri5}) {
		EXPECT_FALSE(path.solve({20, 0, 0}, {-1, 0.2, 0}, {1000, 1e-24, method}));
		EXPECT_TRUE(path.exhausted());
		EXPECT_FALSE(path.nudged());
		EXPECT_TRUE(path.solve({20, 0, 0}, {-1, 0.2, 0}, {1000, 1e-9, method}));
		EXPECT_FALSE(path.exhausted());
	}
	EXPECT_TRUE(path.solve({20, 0, 0}, {-1, 0.2, 0}, {1000, 1e-24, Method::exact}));
}
