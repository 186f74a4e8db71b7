// SPDX-License-Identifier: AGPL-3.0-or-later
/// The rays of extremes.h by the atlas, where it has them: what it may not know it must leave to a path.
#include "extremes.h"

#include "blackhole/route.h"

#include <gtest/gtest.h>

using namespace blackhole;
using extremes::Charted_Figures;
using extremes::Ray;
TEST(Extremes_Routes, KeepEveryPromise) {
	const Settings settings[] = {{1000, 1e-3, Method::rk4}, {10, 1e-4, Method::rk4}, {1.6, 1e-2, Method::rk4},
		{1e6, 5e-4, Method::dopri5}, {1e12, 1e-4, Method::rk4}, {1e15, 5e-4, Method::rk4}, {1.5000001, 1e-3, Method::rk4}};
	int failures = 0;
	for (const Settings& s : settings) {
		const Atlas atlas(s);
		Charted_Figures worst;
		for (int kind = 0; kind <= extremes::kinds; kind++) {
			std::mt19937_64 random(std::uint64_t(300 + kind));
			for (int i = 0; i < 6000 && failures < 20; i++) {
				Ray ray;
				if (!extremes::generate(kind, s, i % 4 == 0, random, ray))
					continue;
				const std::string what = extremes::check(ray, atlas, worst);
				EXPECT_EQ(what, "") << kind << ": " << ray.text();
				failures += !what.empty();
			}
		}
		worst.print(extremes::words("R %g, tolerance %g", s.effect_radius, s.tolerance).c_str());
		EXPECT_GT(worst.charted + worst.through, s.effect_radius < 1.6 ? 0 : 500);
	}
}

// Found by extremes_long, November 2026: a ramp's longest step far out, 0.4 radians, was 1e-4 off.
TEST(Extremes_Routes, RampsFarOutStayMended) {
	Ray ray;
	ray.x = {0x1.6f79c65c6b735p+18, -0x1.0f67daeb5e6bdp+16, 0x1.e4bf468a9ed84p+17};
	ray.d = {-0x1.e8e5b7f5dcf68p-3, 0x1.187fdd450472bp-4, -0x1.58ab47da5bbc1p-3};
	ray.settings = {0x1.bd681ee89699bp+18, 0x1.7d3e1749f0624p-14, Method::dopri5};
	ray.ramp = true;
	Charted_Figures worst;
	EXPECT_EQ(extremes::check(ray, Atlas(ray.settings), worst), "") << ray.text();
	EXPECT_EQ(worst.charted, 1);
}
