// SPDX-License-Identifier: AGPL-3.0-or-later
/// What direction each pixel sees the sky in, against exact geodesics; and which pixels are black.
#include "coordinates.h"
#include "blackhole/orbit.h"
#include "blackhole/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace blackhole;

namespace {

constexpr double R = 10000;  // the default
const Vec3 centre{3, -2, 5}; // not at the origin, and not of size one
constexpr double Rs = 0.5;

enum Frame { fixed, falling, coordinate };
const char* const names[] = {"static", "falling", "coordinate"};

// The frames of physics.md once more, written for the test alone: components along and across the outward radial.
bool to_coordinate(Frame frame, const Vec3& x, const Vec3& d, Vec3& out) {
	const double r = length(x);
	const Vec3 e = (1 / r) * x;
	const double dr = dot(d, e), beta = std::sqrt(1 / r), fR = 1 - 1 / R;
	const Vec3 dt = d - dr * e;
	if (frame == coordinate || (frame == fixed && r >= R))
		out = d;
	else if (frame == fixed)
		out = (dr * std::sqrt((1 - 1 / r) / fR)) * e + dt;
	else {
		if (1 + beta * dr <= 0)
			return false;
		out = r < R ? ((dr + beta) / std::sqrt(fR)) * e + dt : (dr + beta) * e + std::sqrt(1 - 1 / r) * dt;
	}
	return true;
}

// The exact answer for a ray from anywhere: straight to the sphere, exact inside. False: black.
bool exact_sky(Vec3 x, Vec3 d, Vec3& direction, double& b) {
	const double r = length(x);
	b = 1e300;
	direction = unit(d);
	if (r >= R) {
		const double along = dot(x, direction), square = along * along - (r * r - R * R);
		if (along >= 0 || square <= 0)
			return true;
		x = x + (-along - std::sqrt(square)) * direction;
	}
	Vec3 position;
	return oracle::exit_direction(x, d, R, direction, position, &b);
}

// Renders a camera at r radii, looking at the hole or past it, and compares every pixel.
void compare(Frame frame, double r, double tolerance, double pixel, Vec3 look) {
	const int w = 16, h = 12;
	const Vec3 x = r * unit({0.3, 0.5, -1});
	const Camera camera(centre + Rs * x, look, pixel, w, h);
	const std::string scene = camera.text() + "sky_sphere { Coordinates(1.01) }\nblackhole { " + text_of(centre) + ", " +
							  number(Rs) + " tolerance " + number(tolerance) + " camera \"" + names[frame] + "\" }";
	const Seen seen = see(scene, 1.01, w, h);
	if (seen.values.empty())
		return;
	double worst = 0;
	int black = 0, near = 0, wrong = 0;
	for (int j = 0; j < h; j++)
		for (int i = 0; i < w; i++) {
			Vec3 d, direction;
			double b = 0;
			const bool something = to_coordinate(frame, x, camera.pixel(i, j), d) && exact_sky(x, d, direction, b);
			// The camera's numbers take a rounding on their way through the scene file.
			if (something == seen.is_black(i, j) && std::fabs(b / critical_b - 1) > 1e-9)
				wrong++;
			black += seen.is_black(i, j);
			if (!something || std::fabs(b / critical_b - 1) < 1e-3) {
				near += something;
				continue;
			}
			worst = std::max(worst, length(direction - seen.at(i, j)));
		}
	std::printf("%-10s r %-6g tolerance %.0e: worst %.2e rad = %.3f of it; %d of %d black, %d near b_c\n", names[frame], r,
		tolerance, worst, worst / tolerance, black, w * h, near);
	EXPECT_EQ(wrong, 0) << "pixels black that should not be, or the other way round";
	EXPECT_LT(worst, tolerance + 5e-8) << "5e-8: what the colours resolve";
}

} // namespace

class Sky : public testing::TestWithParam<double> {};

TEST_P(Sky, StaticCamera) {
	const Vec3 in = unit({-0.3, -0.5, 1});
	for (double r : {30000.0, 50.0, 7.0, 3.0})
		compare(fixed, r, GetParam(), r > R ? 0.9 / r : r > 10 ? 0.02 : 0.12, in + 0.05 * Vec3{1, 0, 0});
	compare(fixed, 1.6, GetParam(), 0.15, -in);
	compare(fixed, 1.5, GetParam(), 0.15, cross(in, {0, 1, 0}));
	compare(fixed, 1.1, GetParam(), 0.06, -in);
}

TEST_P(Sky, FallingCamera) {
	const Vec3 in = unit({-0.3, -0.5, 1});
	for (double r : {30000.0, 20.0, 3.0, 1.5, 1.0, 0.6, 0.05})
		compare(falling, r, GetParam(), r > R ? 3 / r : 0.12, r > 2 ? in : cross(in, {0, 1, 0}) - 0.3 * in);
}

TEST_P(Sky, CoordinateCamera) {
	const Vec3 in = unit({-0.3, -0.5, 1});
	for (double r : {50.0, 4.0, 1.4})
		compare(coordinate, r, GetParam(), r > 10 ? 0.02 : 0.12, r > 2 ? in : -in);
}

INSTANTIATE_TEST_SUITE_P(Tolerance, Sky, testing::Values(1e-2, 1e-3, 1e-4, 1e-5, 1e-6));

// The picture of a hole does not depend on its size, as long as the scene has that size too; nor on chords being made.
TEST(Sky, IsTheSameAtEverySize) {
	const std::string sky = "sky_sphere { pigment { checker rgb 0.2 rgb 1 scale 0.3 } } ";
	Rendering first;
	for (double size : {1.0, 1e-9, 1e-4, 1e6, 1e9}) {
		const Camera camera({0, 3 * size, -20 * size}, {0, -0.1, 1}, 0.02, 32, 24);
		// Fog so thin that it cannot be seen: it makes chords where the sky alone needs none.
		for (const char* fog : {"", "fog { distance 1e300 rgb 0 } "}) {
			const Rendering run = povray(camera.text() + sky + fog + "blackhole { 0, " + number(size) + " }", 32, 24);
			ASSERT_FALSE(run.picture.samples.empty()) << run.text;
			if (first.picture.samples.empty())
				first = run;
			int different = 0;
			for (std::size_t i = 0; i < run.picture.samples.size(); i++)
				different += run.picture.samples[i] != first.picture.samples[i];
			// A pixel on a checker's edge may fall to the other side by a rounding.
			EXPECT_LE(different, 3) << "size " << size << fog;
		}
	}
}

// The shadow's half-angle in a picture, to a hundredth of a pixel of 0.02 degrees: the black disc's area.
TEST(Shadow, HasTheHalfAngleOfTheFormula) {
	const struct { double r, degrees; } cases[] = {{10, 14.2697}, {3, 45.0014}};
	for (const auto& c : cases) {
		const int n = 801;
		const double pixel = 2.4 * std::tan(c.degrees * 3.14159265358979323846 / 180) / n;
		const Camera camera({0, 0, -c.r}, {0, 0, 1}, pixel, n, n);
		const Rendering run = povray(camera.text() + "sky_sphere { pigment { rgb 1 } } blackhole { 0, 1 }", n, n);
		ASSERT_FALSE(run.picture.samples.empty()) << run.text;
		double area = 0;
		for (int y = 0; y < n; y++)
			for (int x = 0; x < n; x++)
				area += run.picture.black(x, y);
		const double half = std::atan(std::sqrt(area / 3.14159265358979323846) * pixel) * 180 / 3.14159265358979323846;
		std::printf("shadow from r = %g: %.4f degrees, formula %.4f\n", c.r, half, c.degrees);
		EXPECT_NEAR(half, c.degrees, 0.003) << "counting pixels of a disc of 667 across is good to about 1e-4 of its radius";
	}
}
