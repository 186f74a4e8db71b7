// SPDX-License-Identifier: AGPL-3.0-or-later
/// What a ray gathers along its way round a strong hole, against quadrature along the exact path: media, both fogs,
/// rainbow, fading. (features_test.cpp has the limit of a weak hole.)
#include "coordinates.h"
#include "blackhole/oracle.h"
#include "blackhole/orbit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace blackhole;

namespace {

constexpr double R = 20; // the camera is inside the sphere and sees coordinate directions: no frames in the way
const char* const hole = "blackhole { 0, 1 effect_radius 20 tolerance 1e-5 camera \"coordinate\" bend_lights off }\n";

Camera camera() { return Camera({0, 3, -14}, {0.02, -3, 14}, 0.05, 16, 12); }

// The integral of f (the mean over a step between two points) over the length of the exact path of a pixel; captured tells how it
// ends.
double along(const Camera& c, int x, int y, double stop, const std::function<double(const Vec3& from, const Vec3& to)>& f,
	bool& captured) {
	const std::vector<Vec3> points = oracle::polyline(c.location, c.pixel(x, y), R, 400);
	captured =
		length(points.back()) < 2 || std::any_of(points.begin(), points.end(), [=](const Vec3& q) { return length(q) < stop; });
	double sum = 0;
	for (std::size_t i = 1; i < points.size() && length(points[i - 1]) > stop; i++) {
		const Vec3 step = points[i] - points[i - 1];
		// The last step ends at the wall.
		const double r0 = length(points[i - 1]), r1 = length(points[i]),
					 l = length(step) * (r1 < stop ? (r0 - stop) / (r0 - r1) : 1);
		if (l > 0)
			sum += l * f(points[i - 1], points[i]);
	}
	return sum;
}

struct Worst {
	double off = 0, span = 0;
	int captured = 0, escaped = 0;
};

// Compares a channel of every pixel that promises something with what the integral makes of it.
Worst compare(const char* name, const std::string& scene, int channel,
	const std::function<double(const Vec3& from, const Vec3& to)>& f,
	const std::function<double(double integral, bool captured)>& colour, bool captured_only = false, double stop = 0) {
	const Camera c = camera();
	const Rendering run = povray(c.text() + hole + scene, c.width, c.height);
	Worst w;
	if (run.picture.samples.empty()) {
		ADD_FAILURE() << run.text;
		return w;
	}
	double least = 1, most = 0;
	for (int y = 0; y < c.height; y++)
		for (int x = 0; x < c.width; x++) {
			const Vec3 cr = cross(c.location, c.pixel(x, y));
			const double b = length(cr) / std::sqrt(1 - dot(cr, cr) / std::pow(length(c.location), 3));
			if (std::fabs(b / critical_b - 1) < 1e-2)
				continue; // lengths there are those of many turns
			bool captured = false;
			const double integral = along(c, x, y, stop, f, captured), expected = colour(integral, captured);
			if (captured_only && !captured)
				continue;
			(captured ? w.captured : w.escaped)++;
			const double is = run.picture.at(x, y, channel);

			w.off = std::max(w.off, std::fabs(is - expected));
			least = std::min(least, expected);
			most = std::max(most, expected);
		}
	w.span = most - least;
	std::printf("%s: worst %.1e of a span of %.2f; %d captured, %d escaped\n", name, w.off, w.span, w.captured, w.escaped);
	EXPECT_GT(w.captured, 10);
	return w;
}

// The share of a step inside a sphere round the hole.
double inside(const Vec3& from, const Vec3& to, double radius) {
	const double a = length(from) - radius, b = length(to) - radius;
	return a < 0 && b < 0 ? 1 : a >= 0 && b >= 0 ? 0 : std::min(a, b) / -std::fabs(a - b);
}

} // namespace

TEST(Volume, EmissionCountsTheLengthOfThePath) {
	const Worst w = compare(
		"emission", "sphere { 0, 6 hollow pigment { rgbt 1 } interior { media { emission 0.05 } } }", 0,
		[](const Vec3& p, const Vec3& q) { return 0.05 * inside(p, q, 6); }, [](double i, bool) { return std::min(1.0, i); });
	EXPECT_LT(w.off, 1e-4);
	EXPECT_GT(w.span, 0.3);
	EXPECT_GT(w.escaped, 50);
}

TEST(Volume, AbsorptionAndFadingDimByTheLengthOfThePath) {
	const std::string white = "sky_sphere { pigment { rgb 1 } } ";
	const auto length_inside = [](const Vec3& p, const Vec3& q) { return inside(p, q, 6); };
	const Worst absorbed =
		compare("absorption", white + "sphere { 0, 6 hollow pigment { rgbt 1 } interior { media { absorption 0.08 } } }", 0,
			length_inside, [](double i, bool captured) { return captured ? 0 : std::exp(-0.08 * i); });
	EXPECT_LT(absorbed.off, 1e-4);
	EXPECT_GT(absorbed.span, 0.5);
	const Worst faded = compare("fade_power 1001",
		white + "sphere { 0, 6 hollow pigment { rgbt 1 } interior { fade_distance 4 fade_power 1001 fade_color 0.4 } }", 0,
		length_inside, [](double i, bool captured) { return captured ? 0 : std::exp(-0.6 * i / 4); });
	EXPECT_LT(faded.off, 1e-4);
	EXPECT_GT(faded.span, 0.3);
	const Worst law = compare("fade_power 2",
		white + "sphere { 0, 6 hollow pigment { rgbt 1 } interior { fade_distance 4 fade_power 2 fade_color 0 } }", 0,
		length_inside, [](double i, bool captured) { return captured ? 0
															: i == 0 ? 1
																	 : 1 / (1 + i * i / 16); });
	EXPECT_LT(law.off, 1e-4);
	EXPECT_GT(law.span, 0.3);
}

// In front of the horizon too; and as one fog with one least transmittance, however many chords there are.
TEST(Volume, FogCountsTheLengthOfThePath) {
	const Worst w = compare(
		"fog", "fog { distance 12 color rgbt <1, 1, 1, 0.25> }", 0, [](const Vec3&, const Vec3&) { return 1 / 12.0; },
		[](double i, bool) { return 1 - std::max(0.25, std::exp(-i)); }, true);
	EXPECT_LT(w.off, 1e-4);
}

TEST(Volume, GroundFogIsAsDenseAsThePathIsLow) {
	const Worst w = compare(
		"ground fog", "fog { fog_type 2 distance 4 color rgb 1 fog_offset -1 fog_alt 0.8 up y }", 0,
		[](const Vec3& p, const Vec3& q) {
			const double h = std::max(0.0, (0.5 * (p.y + q.y) + 1) / 0.8);
			return 0.25 / (1 + h * h);
		},
		[](double i, bool) { return 1 - std::exp(-i); }, true);
	EXPECT_LT(w.off, 1e-4);
	EXPECT_GT(w.span, 0.05);
}

// A rainbow belongs to a direction: a bent ray passes through the band of its angles for a while.
TEST(Volume, RainbowIsWhereThePathRunsInItsBand) {
	const Vec3 antisolar = unit({0, -0.3, 1});
	const Worst w = compare(
		"rainbow",
		"rainbow { direction <0, -0.3, 1> up y angle 32.5 width 25 distance 10 arc_angle 360 falloff_angle 360 "
		"color_map { [0 rgb 1] [1 rgb 1] } }",
		0,
		[&](const Vec3& p, const Vec3& q) {
			const double angle = std::acos(dot(unit(q - p), antisolar)) * 180 / 3.14159265358979;
			return angle >= 20 && angle <= 45 ? 0.1 : 0;
		},
		[](double i, bool) { return 1 - std::exp(-i); }, true);
	EXPECT_LT(w.off, 8e-3); // a chord is in the band or not: half of one, 0.08 long, at each edge, over the distance of 10
	EXPECT_GT(w.span, 0.1);
}

// As far as what it hits: a wall round the hole, in front of which rays are bent too.
TEST(Volume, FogEndsAtAWall) {
	const Worst w = compare(
		"fog before a wall", "fog { distance 12 color rgb 1 } sphere { 0, 3.5 pigment { rgb 0 } finish { ambient 0 diffuse 0 } }",
		0, [](const Vec3&, const Vec3&) { return 1 / 12.0; }, [](double i, bool) { return 1 - std::exp(-i); }, true, 3.5);
	EXPECT_LT(w.off, 1e-4);
	EXPECT_GT(w.span, 0.1);
}

// Shadows in media end at the hole: the light that a scattering fog shows is dark behind the horizon.
TEST(Volume, ScatteringIsDarkBehindTheHorizon) {
	const std::string fog =
		"light_source { <0, 0, 30> rgb 1 parallel point_at 0 } "
		"box { -4, 4 hollow pigment { rgbt 1 } interior { media { scattering { 1, 0.1 extinction 0 } samples 100 } } }";
	const std::string view = Camera({14, 0.3, -2.5}, {-1, 0, 0}, 0.01, 40, 3).text();
	const Rendering with = povray(view + fog + "blackhole { 0, 1 effect_radius 1.6 }", 40, 3),
					without = povray(view + fog, 40, 3);
	ASSERT_FALSE(with.picture.samples.empty()) << with.text;
	// Across the shadow, 2.5 behind the centre: of 8 units of lit way, 2 sqrt(1 - 0.3^2) are dark.
	const double share = with.picture.at(20, 1, 0) / without.picture.at(20, 1, 0);
	EXPECT_NEAR(share, 1 - 2 * std::sqrt(1 - 0.09) / 8, 0.02);
}
