// SPDX-License-Identifier: AGPL-3.0-or-later
/// Arcs are their chords: the same ends, and every chord as near the long one as it says.
#include "blackhole/chords.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace blackhole;

TEST(Arcs, AreTheirChordsAndHoldThem) {
	std::mt19937_64 random(3);
	std::uniform_real_distribution<double> u(0, 1);
	int arcs = 0, chords = 0, single = 0;
	for (double R : {9.0, 1000.0, 1e5})
		for (double tolerance : {1e-2, 1e-3, 1e-4, 1e-6})
			for (int i = 0; i < 400; i++) {
				const double r = std::pow(10, 0.05 + u(random) * (std::log10(R) - 0.05)), a = 3.14159265 * u(random);
				const bool ramp = i % 2;
				const int many = 2 + i % 15;
				Path path;
				ASSERT_TRUE(path.solve({r, 0, 0}, {std::cos(a), std::sin(a), 0}, {R, tolerance, Method::rk4}));
				Chords walk(path, tolerance, ramp), one(path, tolerance, ramp);
				Arc arc;
				Chord c;
				for (;;) {
					Chords copy(walk);
					if (!walk.next(arc, many))
						break;
					arcs++;
					single += arc.chords == 1;
					ASSERT_LE(arc.chords, many);
					double length = 0;
					Vec3 at = arc.from;
					for (int j = 0; j < arc.chords; j++) {
						Chord same;
						ASSERT_TRUE(copy.next(c));
						ASSERT_TRUE(one.next(same));
						chords++;
						ASSERT_EQ(blackhole::length(c.from - at), 0) << "chords join, and begin where the arc does";
						ASSERT_LT(blackhole::length(c.to - same.to), 1e-12 * (1 + blackhole::length(c.to)));
						at = c.to;
						length += blackhole::length(c.to - c.from);
						EXPECT_GE(blackhole::length(0.5 * (c.from + c.to)), arc.nearest * (1 - 1e-12));
						EXPECT_LE(blackhole::length(c.to), arc.farthest * (1 + 1e-12));
						const Vec3 along = arc.to - arc.from;
						const double l2 = dot(along, along),
									 t = l2 > 0 ? std::fmin(1, std::fmax(0, dot(c.to - arc.from, along) / l2)) : 0;
						EXPECT_LE(blackhole::length(c.to - arc.from - t * along), arc.bulge * (1 + 1e-9) + 1e-12)
							<< r << " " << a << " " << R;
					}
					ASSERT_LT(blackhole::length(at - arc.to), 1e-12 * (1 + blackhole::length(at)))
						<< r << " " << a << " " << many;
					EXPECT_NEAR(arc.length, length, 0.02 * length) << r << " " << a << " " << R << " " << tolerance;
				}
				EXPECT_FALSE(one.next(c)) << "as many chords either way";
			}
	std::printf("%d arcs, %d of a single chord, of %d chords\n", arcs, single, chords);
	EXPECT_GT(chords, 3 * arcs);
}
