// SPDX-License-Identifier: AGPL-3.0-or-later
/// Rays by the atlas against exact geodesics: the promise that paths keep, kept by charted orbits too.
#include "blackhole/oracle.h"
#include "blackhole/route.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <tuple>

using namespace blackhole;

namespace {

constexpr double pi = 3.14159265358979323846;

double angle_near(const Vec3& q, double phi) {
	double at = std::atan2(q.y, q.x);
	while (at < phi - 3)
		at += 2 * pi;
	return at;
}

} // namespace

class Charts : public testing::TestWithParam<std::tuple<double, double>> {};

// Distance of every chord, direction, place and swept angle at the end, from starts far and near, with and without a ramp.
TEST_P(Charts, KeepTheTolerance) {
	const auto [tolerance, R] = GetParam();
	const Atlas atlas({R, tolerance, Method::rk4});
	std::mt19937_64 random(5);
	std::uniform_real_distribution<double> u(0, 1);
	double direction = 0, place = 0, chords = 0, drift = 0;
	int rays = 0, elsewhere = 0;
	for (int i = 0; i < 240; i++) {
		const double r0 = i % 3 == 0 ? R * (1 - 1e-12) : std::pow(10, 0.003 + u(random) * (std::log10(R) - 0.003));
		const double a = r0 > 40 ? pi - 12 / r0 * u(random) : pi * u(random);
		const Vec3 x{r0, 0, 0}, d{std::cos(a), std::sin(a), 0};
		const oracle::Ray exact(r0, a);
		Route route;
		if (!route.solve(x, d, atlas, i % 2)) {
			elsewhere++;
			continue;
		}
		rays++;
		ASSERT_EQ(route.outcome() == Outcome::escaped, exact.escapes()) << r0 << " " << a;
		drift = std::max(drift, route.drift());
		Chord c;
		Vec3 at = x;
		double phi = 0;
		const int every = std::max(1, int(0.1 / std::sqrt(tolerance)));
		for (int n = 0; route.next(c); n++) {
			ASSERT_EQ(length(c.from - at), 0) << "chords join";
			ASSERT_LT(n, 20000);
			at = c.to;
			for (double t : {0.25, 0.5, 1.0}) {
				const Vec3 q = c.from + t * (c.to - c.from);
				const double r = length(q), angle = angle_near(q, phi);
				EXPECT_GE(r, c.nearest * (1 - 1e-6));
				EXPECT_LE(r, c.farthest * (1 + 1e-6));
				if (t == 1.0)
					phi = angle;
				if (r < 1.0001 || r > 0.9999 * R || std::fabs(r - r0) < 1e-9 || (n + i) % every != 0)
					continue;
				chords = std::max(chords, double(exact.distance(r, angle)) / r / tolerance);
			}
		}
		ASSERT_LT(length(at - route.end()), 1e-12 * R) << "the last chord ends where the ray does";
		Vec3 out, from;
		if (!oracle::exit_direction(x, d, R, out, from))
			continue;
		direction = std::max(direction, length(cross(out, route.end_tangent())) / tolerance);
		place = std::max(place, length(from - route.end()) / R / tolerance);
		EXPECT_NEAR(route.swept(), double(exact.swept(R, exact.turns() ? 1 : 0)), tolerance);
	}
	std::printf(
		"tolerance %.0e  R %-5g  direction %.3f  place %.3f  chords %.3f of it, drift %.1e  (%d rays, %d not charted, %.1f MB)\n",
		tolerance, R, direction, place, chords, drift, rays, elsewhere, 1e-6 * double(atlas.bytes()));
	EXPECT_LT(direction, 0.5);
	EXPECT_LT(place, 0.5);
	EXPECT_LT(chords, 1);
	EXPECT_LT(drift, tolerance);
	EXPECT_GT(rays, 19 * elsewhere) << "few rays need a path of their own";
	EXPECT_LT(atlas.bytes(), 16e6);
}

INSTANTIATE_TEST_SUITE_P(
	From, Charts, testing::Combine(testing::Values(1e-2, 1e-3, 5e-4, 1e-4, 5e-5), testing::Values(3.0, 10.0, 1000.0, 1e5)));

// The way from rim to rim, which is all that a sky needs.
TEST(Atlas, ThroughIsTheClosedFormsExit) {
	for (double tolerance : {1e-2, 1e-3, 1e-4})
		for (double R : {2.0, 9.2, 1000.0}) {
			const Atlas atlas({R, tolerance, Method::rk4});
			double worst = 0;
			int rays = 0;
			for (int i = 0; i < 20000; i++) {
				const double sine = i % 2 ? i / 20000.0 : std::min(1.0, (2.6 + i / 2000.0) / R);
				const Vec3 x{0, R, 0}, d{0.6 * sine, -std::sqrt(1 - sine * sine), 0.8 * sine};
				Escape charted, exact;
				if (!atlas.through(x, d, charted))
					continue;
				ASSERT_TRUE(escape(x, d, R, exact)) << R << " " << sine;
				rays++;
				worst = std::max({worst, length(charted.tangent - exact.tangent), length(charted.at - exact.at),
					std::fabs(charted.phi - exact.phi)});
			}
			EXPECT_GT(rays, R > 3 ? 15000 : 4000);
			EXPECT_LT(worst, 0.01 * tolerance) << R;
		}
}

// Arcs hold their chords, and a walk goes on from a bookmark.
TEST(Route, ArcsHoldTheirChords) {
	std::mt19937_64 random(3);
	std::uniform_real_distribution<double> u(0, 1);
	int arcs = 0, chords = 0;
	for (double R : {9.0, 1000.0, 1e7})
		for (double tolerance : {1e-2, 1e-3, 1e-4}) {
			const Atlas atlas({R, tolerance, Method::rk4});
			for (int i = 0; i < 2000; i++) {
				const double r = std::pow(10, 0.01 + u(random) * (std::log10(R) - 0.01));
				// Of wide orbits a single arc may be all of the way, by more than half a turn.
				const double a = i % 2 ? pi * u(random) : pi - std::asin(std::min(1.0, std::pow(10, 4 * u(random)) / r));
				const int many = 2 + i % 24;
				Route route;
				if (!route.solve({r, 0, 0}, {std::cos(a), std::sin(a), 0}, atlas, i % 4 < 2))
					continue;
				Arc arc;
				Chord c;
				for (;;) {
					const int here = route.bookmark();
					if (!route.next(arc, many))
						break;
					const int there = route.bookmark();
					arcs++;
					route.go_to(here);
					double way = 0;
					const Vec3 along = arc.to - arc.from;
					const double l2 = dot(along, along);
					for (int j = 0; j < arc.chords; j++) {
						ASSERT_TRUE(route.next(c));
						chords++;
						way += length(c.to - c.from);
						const double t = l2 > 0 ? std::min(1.0, std::max(0.0, dot(c.to - arc.from, along) / l2)) : 0;
						EXPECT_LE(length(c.to - arc.from - t * along), arc.bulge)
							<< r << " " << a << " " << R << " " << tolerance << " " << many;
						EXPECT_GE(length(0.5 * (c.from + c.to)), arc.nearest * (1 - 1e-6));
						EXPECT_GE(length(c.to), arc.nearest * (1 - 1e-6));
						EXPECT_LE(length(c.to), arc.farthest * (1 + 1e-6));
					}
					EXPECT_EQ(route.bookmark(), there);
					EXPECT_LT(length(c.to - arc.to), 1e-12 * R);
					EXPECT_NEAR(arc.length, way, 0.03 * way) << r << " " << a << " " << R << " " << tolerance << " " << many;
				}
			}
		}
	EXPECT_GT(chords, 3 * arcs);
}

// A sphere so small that only a few rows of orbits leave it.
TEST(Atlas, ThroughIsTheClosedFormsExitOfTheSmallestSpheres) {
	int rays = 0;
	for (double tolerance : {0.1, 1e-2, 5e-4})
		for (double R = 1.5575; R < 1.5625; R += 1e-4) {
			const Atlas atlas({R, tolerance, Method::rk4});
			const double least = critical_b * (1 + Atlas::band), rim = R / std::sqrt(1 - 1 / R);
			for (int i = 0; i < 100; i++) {
				const double across = (least + (rim - least) * (i + 0.5) / 100) / R;
				const Vec3 x{R, 0, 0}, d = unit({-std::sqrt(1 - across * across * (1 - 1 / R)), across, 0});
				Escape charted, exact;
				if (!(rim > least) || !atlas.through(x, d, charted))
					continue;
				ASSERT_TRUE(escape(x, d, R, exact)) << R << " " << i;
				rays++;
				ASSERT_LT(length(charted.tangent - exact.tangent), 0.01 * tolerance) << R << " " << i;
			}
		}
	EXPECT_GT(rays, 10000);
}

// Where light hardly bends knots are far apart, and rays end between them: within what chords leave of the tolerance.
TEST(Route, KeepsItsDirectionFarOut) {
	std::mt19937_64 random(7);
	std::uniform_real_distribution<double> u(0, 1);
	for (double tolerance : {5e-5, 5e-4, 5e-3})
		for (double R : {1e3, 1e4, 1e6}) {
			const Atlas atlas({R, tolerance, Method::rk4});
			double worst = 0;
			int rays = 0;
			for (int i = 0; i < 20000; i++) {
				const double b = 2.7 * std::pow(R / 3, u(random)), r = i % 2 ? R : b * std::pow(R / b, u(random));
				const double across = b / r, square = 1 - across * across * (1 - 1 / r);
				if (square < 0)
					continue;
				const Vec3 x{r, 0, 0}, d = unit({(i % 4 ? -1 : 1) * std::sqrt(square), across, 0});
				Route route;
				Escape exact;
				if (!route.solve(x, d, atlas, false))
					continue;
				ASSERT_TRUE(escape(x, d, R, exact)) << r << " " << b;
				rays++;
				worst = std::max(worst, length(route.end_tangent() - exact.tangent));
			}
			EXPECT_GT(rays, 8000);
			EXPECT_LT(worst, 0.25 * tolerance) << R << " " << tolerance;
		}
}

TEST(Atlas, IsNotMadeWhereItCannotKeepThePromise) {
	EXPECT_EQ(Atlas({1000, 1e-6, Method::rk4}).bytes(), 0u);
	EXPECT_EQ(Atlas({1000, 1e-3, Method::exact}).bytes(), 0u);
	Route route;
	EXPECT_FALSE(route.solve({20, 0, 0}, {-1, 0.3, 0}, Atlas({1000, 1e-6, Method::rk4}), false));
	const Atlas atlas({1000, 1e-3, Method::rk4});
	EXPECT_FALSE(route.solve({20, 0, 0}, {-1, 0, 0}, atlas, false)) << "radial";
	EXPECT_FALSE(route.solve({1.2, 0, 0}, {0.1, 1, 0}, atlas, false)) << "bound to fall, b > b_c";
	EXPECT_FALSE(route.solve({0.9, 0, 0}, {1, 0.1, 0}, atlas, false)) << "inside the horizon";
}
