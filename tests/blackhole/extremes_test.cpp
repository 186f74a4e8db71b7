// SPDX-License-Identifier: AGPL-3.0-or-later
/// Numerical stability at the extremes: a million rays where cameras, mirrors and rounding may put them.
#include "extremes.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <algorithm>

using namespace blackhole;
using namespace extremes;

class Extremes : public testing::TestWithParam<int> {};

TEST_P(Extremes, KeepEveryPromise) {
	const Kind kind = Kind(GetParam());
	std::mt19937_64 random(100 + kind);
	Path path;
	Figures figures;
	int failures = 0, tried = 0;
	for (; figures.rays < 100000 && tried < 1000000; tried++) {
		const Ray ray = generate(kind, random);
		if (!allowed(ray))
			continue;
		const std::string what = check(ray, tried % 16 == 0, path, figures);
		EXPECT_EQ(what, "") << ray.text();
		if (!what.empty() && ++failures >= 20)
			break;
	}
	figures.print(kind_names[kind]);
	EXPECT_GE(figures.rays, 100000);
}

INSTANTIATE_TEST_SUITE_P(Of, Extremes, testing::Range(0, int(kinds)), [](const testing::TestParamInfo<int>& i) {
	std::string name = kind_names[i.param];
	for (char& c : name)
		c = c == ' ' ? '_' : c;
	return name;
});

namespace {

/// The outcome in fifty digits, by the impact parameter (as classify_test.cpp has it); margin: of b^2 from 27/4.
Outcome fifty_digits(const Ray& ray, double& margin) {
	using Exact = boost::multiprecision::cpp_bin_float_50;
	const Exact a = ray.x.x, b = ray.x.y, c = ray.x.z, e = ray.d.x, f = ray.d.y, g = ray.d.z;
	const Exact i = b * g - c * f, j = c * e - a * g, k = a * f - b * e;
	const Exact r2 = a * a + b * b + c * c, s = a * e + b * f + c * g, r = sqrt(r2);
	const Exact h2 = (i * i + j * j + k * k) / (e * e + f * f + g * g), beyond = h2 - Exact(27) / 4 * (1 - h2 / (r2 * r));
	margin = r == Exact(3) / 2 ? 0 : std::fabs(double(beyond / h2));
	if (r == Exact(3) / 2)
		return s > 0 ? Outcome::escaped : Outcome::captured;
	if (r > Exact(3) / 2)
		return s >= 0 || beyond > 0 ? Outcome::escaped : Outcome::captured;
	return s > 0 && beyond < 0 ? Outcome::escaped : Outcome::captured;
}

} // namespace

// The quadruple witness and the library, against fifty digits, where it matters.
TEST(Extremes_Outcome, IsThatOfFiftyDigits) {
	std::mt19937_64 random(5);
	double closest = 1;
	for (int i = 0, seen = 0; seen < 100000; i++) {
		const Kind some[] = {at_the_edge, critical, extremes::photon_sphere, inside};
		const Ray ray = generate(some[i % 4], random);
		if (!allowed(ray))
			continue;
		double margin, other;
		const Outcome exact = fifty_digits(ray, margin);
		if (i % 4 != 3 && margin > 1e-6)
			continue;
		seen++;
		closest = margin > 0 ? std::min(closest, margin) : closest;
		ASSERT_EQ(classify(ray.x, ray.d), exact) << ray.text();
		ASSERT_EQ(witness(ray, other), exact) << ray.text();
		ASSERT_EQ(Launch(ray.x, ray.d).outcome, exact) << ray.text();
	}
	std::printf("[ extremes ] 100000 outcomes as in fifty digits, the closest %.1e from b_c^2\n", closest);
	EXPECT_LT(closest, 1e-30); // on the photon sphere it is the square of a rounding
}

// Exactly critical rays: cos^2 a = 9/11 at r = 6 in whole numbers, 11 (x.d)^2 = 9 x^2 d^2. Equality is capture.
TEST(Extremes_Outcome, EqualityIsCapture) {
	int found = 0;
	for (int a = -60; a <= 60; a++)
		for (int b = -60; b <= 60; b++)
			for (int c = -60; c <= 60; c++) {
				const int s = 2 * a + 4 * b + 4 * c;
				if (s >= 0 || 11 * s * s != 324 * (a * a + b * b + c * c))
					continue;
				found++;
				const Vec3 x{2, 4, 4}, d{double(a), double(b), double(c)};
				ASSERT_EQ(classify(x, d), Outcome::captured) << a << " " << b << " " << c;
				ASSERT_EQ(Launch(x, d).outcome, Outcome::captured) << a << " " << b << " " << c;
				Path path;
				ASSERT_TRUE(path.solve(x, d, {1000, 1e-3, Method::rk4})) << a << " " << b << " " << c;
			}
	std::printf("[ extremes ] %d exactly critical rays\n", found);
	EXPECT_GT(found, 0);
}

// What the rays above have found, November 2026: each failed before it was mended.
TEST(Extremes_Found, StaysMended) {
	const double R = 1000, t = 1e-3, ulp = 0x1p-52;
	const Ray found[] = {
		{{10, 0, 0}, {-1e-310, 3e-311, 0}, {R, t, Method::rk4}},                           // subnormal: NaN
		{{10, 0, 0}, {-1e300, 3e299, 0}, {R, t, Method::rk4}},                             // huge: stood still
		{{1.5, 0, 0}, {0, 1, 0}, {R, t, Method::rk4}},                                     // circled for ever
		{{1.5 + ulp, 0, 0}, {0, 1, 0}, {R, 1e-6, Method::rk4}},                            // for 80 radians; escape() gave NaN
		{{1, 0, 0}, {1e-17, 1, 0}, {R, t, Method::rk4}},                                   // no energy: infinite b
		{{0.8936328857148268, 0, 0}, {0.9896, 0.1439, 0}, {1.5000001, 0.05, Method::rk4}}, // chords began inside
		{{1.5000000000000007, 0, 0}, {1, 0, 0}, {1.5000000000000004, t, Method::rk4}},     // a piece of no length: NaN
		{{21231.096651302487, 0, 0}, {-0.9867, 0.1608, 0}, {21231.096651302487, 0.00102, Method::rk4}}, // one chord for all of it
		{{1e12, 0, 0}, {-1, 2e-9, 0}, {1e12, 0.001, Method::rk4}}, // the same, hundreds of tolerances off
		{{929265146191.65271, 0, 0}, {-0.99999999965, 2.6e-5, 0},
			{929265146191.65271, 0.1, Method::rk4}},                // and its end was far off
		{{1e12, 0, 0}, {-1, 5.83e-4, 0}, {1e12, 0.1, Method::rk4}}, // likewise
		{{983627998785.0105, 0, 0}, {-0x1.fff18982a4065p-1, 0x1.e6c571c22dff8p-7, 0},
			{983627998785.0105, 1e-4, Method::rk4}},                                         // and
		{{1e-6 + 1e-7, 0, 0}, {1, 0, 0}, {R, t, Method::rk4}},                               // a million steps
		{{2.64e-06, 0, 0}, {1, 1.9e-17, 0}, {1.5000001, 0.1, Method::dopri5}},               // likewise
		{{6e11, -5e11, 6e11}, {-6e11 + 1.92, 5e11 + 2.3, -6e11}, {1e12, 1e-9, Method::rk4}}, // b off by 2e-8
		{{1.5 + 3 * ulp, 0, 0}, {-1e-17, 1, 0}, {R, t, Method::exact}},                      // u below 0
		{{1.5, 0, 0}, {4.9e-324, 1, 0}, {1.5 + ulp, 0.1, Method::exact}},                    // likewise
		{{1.5, 0, 0}, {0, 1, 0}, {R, t, Method::exact}},                                     // never got to the horizon
		{{198.028401188507, 0, 0}, {0.99, 0.1, 0}, {198.028401188507, t, Method::exact}},    // did not end on the sphere
		{{0x1.22a6abf990559p-1, 0x1.89c3a328cf893p-1, 0x1.2cc5944a6a61fp-2},
			{-0x1.bcf5348e9e96cp-2, -0x1.2d682a5fe5914p-1, -0x1.cc73a06d0ed8ep-3},
			{1.5 + ulp, 1e-4, Method::exact}}, // energy lost
		// The five of the first hundred million: the method's error at the far end, seen from the middle of a chord past the
		// hole; a crossing looked for where the ray stands on it.
		{{0x1.16c882a5381a1p+29, 0, 0}, {-0x1.fc9b428e6d682p-1, 0x1.d6ceea7e08946p-4, 0},
			{0x1.16c882a5381a1p+29, 0x1.ad4a55318d535p-19, Method::rk4}},
		{{0x1.954299f500855p+31, 0, 0}, {-0x1.42e1c269ed0dp-100, 0x1.04691635938aep-103, 0},
			{0x1.954299f500855p+31, 0x1.ac5a242c33735p-18, Method::rk4}},
		{{-0x1.ae81fa48de422p+34, 0x1.1f37f531b073fp+34, 0x1.da0655580fecap+34},
			{0x1.f631a483ca0c2p-666, -0x1.ae7c39e252baap-667, -0x1.19006d8c3d4c9p-665},
			{0x1.5ee7188d38fccp+35, 0x1.a2825077046dbp-29, Method::rk4}},
		{{0x1.0dcd2d5253e6fp+35, 0, 0}, {-0x0.0125335d0607fp-1022, 0x0.001bfe93493aap-1022, 0},
			{0x1.0dcd2d5253e6fp+35, 0x1.3d2541f9c34ccp-20, Method::rk4}},
		{{0x1.10c849f216d96p+1, 0, 0}, {0, 1, 0}, {0x1.10c849f216d96p+1, 0x1.a2c990d82e4e8p-29, Method::dopri5}},
	};
	Path path;
	Figures figures;
	for (const Ray& ray : found) {
		ASSERT_TRUE(allowed(ray)) << ray.text();
		EXPECT_EQ(check(ray, true, path, figures), "") << ray.text();
	}
}

// The finest tolerance the scene language has, where it is hardest: just outside the 0.1 % band, from ever farther away.
TEST(Extremes_Tolerance, TheFinestIsKeptByAllMethodsHoweverFar) {
	for (const Method method : {Method::rk4, Method::dopri5, Method::exact})
		for (const double R : {1.6, 10.0, 1e3, 1e6, 1e9, 1e12, 1e15}) {
			std::mt19937_64 random(9);
			std::uniform_real_distribution<double> u(0, 1);
			std::normal_distribution<double> n;
			double worst = 0;
			std::size_t most = 0;
			int rays = 0;
			for (int i = 0; i < 200; i++) {
				const double r = R * (1 - 1e-3 * u(random)), b = critical_b * (1 + 1.001e-3 * std::pow(100, u(random)));
				const double sine = b / r / std::sqrt(1 + b * b / (r * r * r));
				if (!(sine < 1))
					continue;
				const Vec3 e = unit({n(random), n(random), n(random)}), t = unit(cross(e, {n(random), n(random), n(random)}));
				const Vec3 x = r * e, d = -std::sqrt(1 - sine * sine) * e + sine * t;
				Path path;
				Escape out;
				ASSERT_TRUE(path.solve(x, d, {R, 1e-9, method}));
				// From afar b's last digits may be in the band, or beyond it.
				if (std::fabs(path.orbit().h / critical_b - 1) < 1e-3 || !escape(x, d, R, out))
					continue;
				rays++;
				most = std::max(most, path.nodes().size());
				worst = std::max({worst, length(path.end_tangent() - out.tangent), length(path.end() - R * out.at) / R});
			}
			std::printf("[ extremes ] %s, 1e-9, effect radius %g: off by %.4f of it at most (%d rays, %zu nodes)\n",
				method_names[int(method)], R, worst / 1e-9, rays, most);
			EXPECT_GT(rays, 30);
			EXPECT_LT(worst, 1e-9);
		}
}
