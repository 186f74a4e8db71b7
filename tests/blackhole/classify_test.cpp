// SPDX-License-Identifier: AGPL-3.0-or-later
/// Captured or escaped, against the same rule in 50 digits and against the turning points of the cubic.
#include "blackhole/orbit.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace blackhole;
using Exact = boost::multiprecision::cpp_bin_float_50;

namespace {

// The escape rule about the doubles as given. Not the library's formula: the impact parameter against b_c, with the
// side of the photon sphere deciding what that means (Chandrasekhar 1983, chapter 3, eq. 230 ff.).
Outcome witness(const Vec3& x, const Vec3& d) {
	const Exact a = x.x, b = x.y, c = x.z, e = d.x, f = d.y, g = d.z;
	const Exact i = b * g - c * f, j = c * e - a * g, k = a * f - b * e;
	const Exact r2 = a * a + b * b + c * c, d2 = e * e + f * f + g * g, s = a * e + b * f + c * g;
	const Exact r = sqrt(r2), h2 = (i * i + j * j + k * k) / d2;
	const Exact b2 = h2 / (1 - h2 / (r2 * r));
	const Exact bc2 = Exact(27) / 4;
	if (r > Exact(3) / 2)
		return s >= 0 || b2 > bc2 ? Outcome::escaped : Outcome::captured;
	if (r == Exact(3) / 2)
		return s > 0 ? Outcome::escaped : Outcome::captured;
	return s > 0 && b2 < bc2 ? Outcome::escaped : Outcome::captured;
}

Vec3 turned(std::mt19937_64& random, const Vec3& v) {
	std::normal_distribution<double> n;
	const Vec3 a = unit({n(random), n(random), n(random)}), b = unit(cross(a, {n(random), n(random), n(random)}));
	return v.x * a + v.y * b + v.z * cross(a, b);
}

} // namespace

TEST(Classify, AgreesWithFiftyDigits) {
	std::mt19937_64 random(7);
	std::uniform_real_distribution<double> u(0, 1);
	const double radii[] = {1e6, 1000, 25, 7.5, 3.0000001, 2.9999999, 1.6, 1.5000001, 1.5, 1.4999999, 1.2, 1.0001};
	for (double r : radii)
		for (int i = 0; i < 3000; i++) {
			const double a = std::acos(1 - 2 * u(random));
			// Both vectors in general position: the doubles' own roundings are part of the question.
			std::mt19937_64 turn = random;
			const Vec3 x = turned(random, {r, 0, 0}), d = turned(turn, {std::cos(a), std::sin(a), 0});
			ASSERT_EQ(classify(x, d), witness(x, d)) << "r " << r << ", a " << a;
		}
}

// As near to critical as doubles go: the angle is stepped by single roundings across the edge.
TEST(Classify, IsExactToTheLastBitAtTheEdge) {
	int escaped = 0, captured = 0;
	for (double r : {1000.0, 25.0, 3.0, 2.0, 1.5, 1.4, 1.01}) {
		const double k = (1.5 - r) * std::sqrt((r + 3) / (r * r * r + 6.75));
		const double s = std::sqrt(1 - k * k);
		double c = k;
		for (int i = 0; i < 20; i++)
			c = std::nextafter(c, -2);
		for (int i = 0; i < 40; i++, c = std::nextafter(c, 2)) {
			const Vec3 x{r, 0, 0}, d{c, s, 0};
			ASSERT_EQ(classify(x, d), witness(x, d)) << "r " << r << ", step " << i;
			(classify(x, d) == Outcome::escaped ? escaped : captured)++;
		}
	}
	EXPECT_GT(escaped, 40); // the edge was crossed
	EXPECT_GT(captured, 40);
}

TEST(Classify, KnownCases) {
	EXPECT_EQ(classify({10, 0, 0}, {-1, 0, 0}), Outcome::captured);
	EXPECT_EQ(classify({10, 0, 0}, {1, 0, 0}), Outcome::escaped);
	EXPECT_EQ(classify({1.5, 0, 0}, {0, 1, 0}), Outcome::captured); // on the photon sphere: equality is capture
	EXPECT_EQ(classify({1.0000001, 0, 0}, {1, 0, 0}), Outcome::escaped);
	EXPECT_EQ(classify({1.0000001, 0, 0}, {0.3, std::sqrt(1 - 0.09), 0}), Outcome::captured);
	EXPECT_EQ(classify({0.5, 0, 0}, {1, 0, 0}), Outcome::escaped); // from inside, radially outward
	EXPECT_EQ(classify({0.5, 0, 0}, {1, 0.99, 0}), Outcome::captured);
	// The length of the direction does not matter, not even near the ends of the exponent's range.
	EXPECT_EQ(classify({10, 0, 0}, {-1e200, 2.4e199, 0}), classify({10, 0, 0}, {-1, 0.24, 0}));
	EXPECT_EQ(classify({10, 0, 0}, {-1e-200, 2.8e-201, 0}), classify({10, 0, 0}, {-1, 0.28, 0}));
}
