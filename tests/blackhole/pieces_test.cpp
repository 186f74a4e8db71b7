// SPDX-License-Identifier: AGPL-3.0-or-later
/// Pieces hold their chords, and so the exact curve to the tolerance: the same ends, and every corner as near the long chord as
/// they say.
#include "blackhole/closed.h"
#include "blackhole/route.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

using namespace blackhole;

namespace {

constexpr double pi = 3.14159265358979323846;

// How far a corner is from the segment, as in Pieces.
double away(Vec2 at, const Pieces& p, int i) {
	const Vec2 along{p.dx[i], p.dy[i]}, off = at - Vec2{p.x[i], p.y[i]};
	const double square = dot(along, along), t = square > 0 ? std::clamp(dot(off, along) / square, 0.0, 1.0) : 0;
	return length(off - t * along);
}

struct Seen {
	int pieces = 0, narrow = 0;
	double fullest = 0, sum = 0; // the part of the bulge that is needed
};

// All pieces of a route, of so many chords, against its chords.
void check(const Atlas& atlas, const Vec3& x, const Vec3& d, bool ramp, int many, Seen& seen) {
	Route route;
	if (!route.solve(x, d, atlas, ramp))
		return;
	const double tolerance = atlas.settings().tolerance, slack = 5e-7;
	Pieces p;
	Chord c;
	int chords = 0;
	for (int first = 0; first < route.chords();) {
		const int count = route.pieces(first, route.chords(), many, p);
		ASSERT_GE(count, 1);
		ASSERT_LE(count, 4);
		for (int i = 0; i < count; i++, first += many) {
			double way = 0, most = 0, far = 0;
			Vec2 at{};
			for (int j = 0; j < many && first + j < route.chords(); j++, chords++) {
				ASSERT_TRUE(route.next(c));
				way += length(c.to - c.from);
				const Vec2 from{dot(c.from, route.e1()), dot(c.from, route.e2())};
				at = {dot(c.to, route.e1()), dot(c.to, route.e2())};
				EXPECT_NEAR(length(c.to), length(at), 1e-12 * length(at)) << "out of the plane";
				if (j == 0)
					EXPECT_LT(length(from - Vec2{p.x[i], p.y[i]}), slack * length(from)) << "begins elsewhere";
				EXPECT_LE(away(from, p, i), p.bulge[i]);
				EXPECT_LE(away(at, p, i), p.bulge[i]) << length(x) << " " << many << " " << tolerance;
				EXPECT_GE(length(0.5 * (c.from + c.to)), p.nearest[i]);
				EXPECT_GE(length(c.to), p.nearest[i]);
				far = std::max({far, length(c.from), length(c.to)});
				most = std::max(most, away(at, p, i));
			}
			EXPECT_LT(length(at - Vec2{p.x[i] + p.dx[i], p.y[i] + p.dy[i]}), slack * far) << "ends elsewhere";
			EXPECT_LE(far, p.farthest[i]);
			EXPECT_NEAR(p.length[i], way, 0.02 * way + slack * far);
			// What is left of the bulge without what single precision and charts may lose.
			const double bulge = p.bulge[i] - (1e-6 + (many > 1 ? 0.1 * tolerance : 0)) * far;
			seen.pieces++;
			if (many > 1 && bulge > 1e-3 * far) {
				seen.narrow++;
				seen.fullest = std::max(seen.fullest, most / bulge);
				seen.sum += most / bulge;
			}
		}
	}
	EXPECT_EQ(chords, route.chords());
}

} // namespace

TEST(Pieces, HoldTheirChords) {
	std::mt19937_64 random(5);
	std::uniform_real_distribution<double> u(0, 1);
	Seen seen;
	for (double R : {1.7, 3.0, 9.0, 40.0, 1000.0, 1e4, 1e9})
		for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 5e-5}) {
			const Atlas atlas({R, tolerance, Method::rk4});
			for (int i = 0; i < 1500; i++) {
				// From anywhere, or, every other, in from the rim.
				const double r = i % 2 ? R : std::pow(10, 0.01 + u(random) * (std::log10(R) - 0.01));
				// Of wide orbits a single piece may be all of the way, by more than half a turn.
				const double b = i % 4 < 2 ? 12 * u(random) : std::pow(10, 1 + 4 * u(random));
				const double a = i % 4 ? pi - std::asin(std::min(1.0, b / r)) : pi * u(random), turn = 2 * pi * u(random);
				const Vec3 x{r * std::cos(turn), r * std::sin(turn), 0};
				const Vec3 d{std::cos(turn) * std::cos(a), std::sin(turn) * std::cos(a), std::sin(a)};
				for (const int many : {1, 4, 16, 64})
					if (many <= std::max(1.0, 0.3 / std::sqrt(tolerance)))
						check(atlas, x, d, i % 3 == 0, many, seen);
				if (HasFailure())
					return;
			}
		}
	std::printf("%d pieces; of %d that bend, %.3f of the bulge is needed at most, %.2f on average\n", seen.pieces, seen.narrow,
		seen.fullest, seen.sum / seen.narrow);
	EXPECT_GT(seen.narrow, 10000);
	EXPECT_GT(seen.sum / seen.narrow, 0.5) << "so wide that it says nothing";
}

// Begun at any corner and ended at any, pieces are those of the whole way.
TEST(Pieces, DoNotDependOnWhereTheyAreAskedFor) {
	const Atlas atlas({30, 1e-3, Method::rk4});
	Route route;
	ASSERT_TRUE(route.solve({0, 30, 0}, unit({0.15, -1, 0.05}), atlas, false));
	for (int first = 0; first < route.chords(); first++)
		for (int last = first + 1; last <= route.chords(); last++) {
			Pieces some, one;
			const int count = route.pieces(first, last, 4, some);
			EXPECT_EQ(count, std::min(4, (last - first + 3) / 4));
			for (int i = 0; i < count; i++) {
				const int from = first + 4 * i;
				ASSERT_EQ(route.pieces(from, std::min(from + 4, last), 4, one), 1);
				EXPECT_EQ(one.x[0], some.x[i]);
				EXPECT_EQ(one.y[0], some.y[i]);
				EXPECT_EQ(one.dx[0], some.dx[i]);
				EXPECT_EQ(one.dy[0], some.dy[i]);
				EXPECT_EQ(one.bulge[0], some.bulge[i]);
			}
		}
}
