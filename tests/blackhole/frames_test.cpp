// SPDX-License-Identifier: AGPL-3.0-or-later
/// Frames against the figures of Schwarzschild geometry, and each conversion against its inverse.
#include "blackhole/frames.h"
#include "blackhole/orbit.h"

#include <gtest/gtest.h>

#include <random>

using namespace blackhole;

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// Half-angle of the shadow a static observer at r sees: bisection of classify() over the local angle off the hole.
double shadow(double r, double R) {
	double lo = 0, hi = 180 * degree;
	for (int i = 0; i < 60; i++) {
		const double a = (lo + hi) / 2;
		const Vec3 x{r, 0, 0};
		(classify(x, static_to_coordinate(x, {-std::cos(a), std::sin(a), 0}, R)) == Outcome::captured ? lo : hi) = a;
	}
	return lo / degree;
}

} // namespace

TEST(Frames, ShadowOfAStaticObserver) {
	EXPECT_NEAR(shadow(10, 1000), 14.276, 5e-4);
	EXPECT_NEAR(shadow(3, 1000), 45.0143, 5e-5);
	// Synge 1966: sin psi = b_c sqrt(1 - 1/r) / r, as the effect radius grows.
	for (double r : {1.6, 2.0, 3.0, 10.0, 100.0})
		EXPECT_NEAR(shadow(r, 1e9), (r < 1.5 ? 180 : 0) + std::asin(critical_b * std::sqrt(1 - 1 / r) / r) / degree, 1e-5) << r;
	EXPECT_NEAR(shadow(1.5, 1e9), 90, 1e-5);
	EXPECT_NEAR(shadow(1.2, 1e9), 180 - std::asin(critical_b * std::sqrt(1 - 1 / 1.2) / 1.2) / degree, 1e-5);
}

TEST(Frames, StaticIsItsInverseAndNormalsKeepSigns) {
	std::mt19937_64 random(3);
	std::normal_distribution<double> n;
	for (int i = 0; i < 20000; i++) {
		const Vec3 e = unit({n(random), n(random), n(random)}), d = unit({n(random), n(random), n(random)});
		const Vec3 normal = unit({n(random), n(random), n(random)});
		const Vec3 x = (1 + std::exp(6 * n(random))) * e;
		const double R = 1000;
		const Vec3 back = coordinate_to_static(x, static_to_coordinate(x, d, R), R);
		// Near the horizon g loses the digits of 1 - 1/r, in both directions alike.
		ASSERT_LT(length(back - d), 1e-9);
		const Vec3 coordinate = static_to_coordinate(x, d, R);
		ASSERT_GE(dot(coordinate, normal) * dot(d, normal_to_static(x, normal, R)), -1e-15);
	}
}

TEST(Frames, NothingJumpsAtTheEffectSphere) {
	const Vec3 d = unit({0.3, -0.7, 0.2});
	EXPECT_EQ(static_factor(1000, 1000), 1);
	EXPECT_NEAR(static_factor(999.9999999, 1000), 1, 1e-12);
	Vec3 in, out;
	ASSERT_TRUE(falling_to_coordinate({999.9999999, 0, 0}, d, 1000, in));
	ASSERT_TRUE(falling_to_coordinate({1000.0000001, 0, 0}, d, 1000, out));
	EXPECT_LT(length(in - out), 1e-9);
}

// A falling observer is a static one moving at beta = sqrt(1/r): aberration gives the same direction.
TEST(Frames, FallingIsAStaticObserverInMotion) {
	for (double r : {1.1, 1.5, 3.0, 20.0})
		for (double a = 0; a < 3.1; a += 0.1) {
			const double R = 1e12, beta = std::sqrt(1 / r);
			const Vec3 x{r, 0, 0};
			Vec3 c;
			ASSERT_TRUE(falling_to_coordinate(x, {std::cos(a), std::sin(a), 0}, R, c));
			// Light seen from direction a off the outward radial by who falls inward at beta.
			const double cs = (std::cos(a) + beta) / (1 + beta * std::cos(a));
			const Vec3 s = static_to_coordinate(x, {cs, std::sqrt(1 - cs * cs), 0}, R);
			ASSERT_LT(length(c - s), 1e-9) << r << " " << a;
		}
}

TEST(Frames, InsideTheHorizonEveryRayThatIsSomethingStartsOutward) {
	for (double r : {1.0, 0.9, 0.3, 1e-3, 1e-8})
		for (double a = 0; a < 3.14; a += 0.01) {
			const Vec3 x{0, r, 0}, d{std::sin(a), std::cos(a), 0};
			Vec3 c;
			const bool something = falling_to_coordinate(x, d, 1000, c);
			ASSERT_EQ(something, 1 + std::cos(a) / std::sqrt(r) > 0);
			if (something) {
				ASSERT_GT(c.y, 0);
				ASSERT_LT(c.x * c.x, r) << "energy must be positive";
			}
		}
}
