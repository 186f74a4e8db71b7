// SPDX-License-Identifier: AGPL-3.0-or-later
/// Where objects are hit, and how mirrors and glass send light on, against exact geodesics.
#include "coordinates.h"
#include "blackhole/oracle.h"
#include "blackhole/orbit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace blackhole;

namespace {

constexpr double R = 10000;   // the default
constexpr double last = 1000; // no object here is farther; first_hit's steps grow with it
const char* const painted = " Coordinates(40) finish { emission 1 diffuse 0 ambient 0 } ";

double g(double r) { return std::sqrt((1 - 1 / r) / (1 - 1 / R)); }

Vec3 camera_direction(const Vec3& x, const Vec3& pixel) { return unit(radial_times(x, pixel, g(length(x)))); }

struct Hits {
	double worst_distance = 0, worst_point = 0; // of the path, over r; along it too
	int hit = 0, black = 0, wrong = 0;
};

// Every pixel's point lies on its exact path; and, where a ray does not graze, at the exact place on it.
Hits hits(const Camera& camera, const std::string& object, const std::function<double(const Vec3&)>& surface, double tolerance) {
	const std::string scene = camera.text() + object + " blackhole { 0, 1 tolerance " + number(tolerance) + " }";
	const Seen seen = see(scene, 40, camera.width, camera.height);
	Hits h;
	if (seen.values.empty())
		return h;
	for (int j = 0; j < camera.height; j++)
		for (int i = 0; i < camera.width; i++) {
			const Vec3 x = camera.location, d = camera_direction(x, camera.pixel(i, j));
			const Vec3 c = cross(x, d);
			const double b = length(c) / std::sqrt(1 - dot(c, c) / std::pow(length(x), 3));
			Vec3 point, tangent;
			const bool should = oracle::first_hit(x, d, last, surface, point, tangent);
			const bool is = !seen.is_black(i, j);
			if (std::fabs(b / critical_b - 1) < 1e-3 || (should && length(point) > 39))
				continue; // not promised; not painted
			(is ? h.hit : h.black)++;
			// A silhouette may be off by the tolerance: a pixel there is no error.
			if (is != should) {
				h.wrong++;
				continue;
			}
			if (!is)
				continue;
			const Vec3 q = seen.at(i, j);
			h.worst_distance = std::max(h.worst_distance, oracle::distance(x, d, q) / length(q));
			h.worst_point = std::max(h.worst_point, length(q - point) / length(q));
		}
	return h;
}

} // namespace

class Hit : public testing::TestWithParam<double> {};

TEST_P(Hit, PointsLieOnTheExactPath) {
	const double tolerance = GetParam();
	const struct {
		const char* name;
		Camera camera;
		std::string object;
		std::function<double(const Vec3&)> surface;
	} cases[] = {
		{"sphere r = 4 from outside", Camera({0, 3, -12}, {0, -3, 12}, 0.08, 12, 9), std::string("sphere { 0, 4") + painted + "}",
			[](const Vec3& p) { return length(p) - 4; }},
		{"sphere r = 8 from r = 2 inside", Camera({0, 0, -2}, {1, 0.1, -0.2}, 0.15, 12, 9),
			std::string("sphere { 0, 8") + painted + "}", [](const Vec3& p) { return length(p) - 8; }},
		{"sphere r = 8 from r = 1.3", Camera({0, 0, -1.3}, {0.1, 0, -1}, 0.1, 12, 9),
			std::string("sphere { 0, 8") + painted + "}", [](const Vec3& p) { return length(p) - 8; }},
		{"ball behind the hole", Camera({0, 1, -15}, {0, -1, 15}, 0.04, 16, 12),
			std::string("sphere { <1, 0.5, 8>, 2.5") + painted + "}",
			[](const Vec3& p) {
				return length(p - Vec3{1, 0.5, 8}) - 2.5;
			}},
		{"floor", Camera({0, 3, -10}, {0, -3, 10}, 0.08, 12, 9), std::string("plane { y, -2.5") + painted + "}",
			[](const Vec3& p) { return p.y + 2.5; }},
	};
	for (const auto& c : cases) {
		const Hits h = hits(c.camera, c.object, c.surface, tolerance);
		std::printf("%-31s tolerance %.0e: off the path %.3f of it, off the point %.2e; %d hit, %d black, %d other\n", c.name,
			tolerance, h.worst_distance / tolerance, h.worst_point, h.hit, h.black, h.wrong);
		EXPECT_GT(h.hit, 10);
		// 3e-7: what the colours resolve of 80 units, over the nearest hit's radius of 2.5.
		EXPECT_LT(h.worst_distance, tolerance + 3e-7);
		// At most a pixel's width of silhouette can differ, and only where the tolerance is coarse.
		EXPECT_LE(h.wrong, tolerance > 5e-3 ? 3 : tolerance > 5e-4 ? 1 : 0);
	}
}

INSTANTIATE_TEST_SUITE_P(Tolerance, Hit, testing::Values(1e-2, 1e-3, 1e-4, 1e-5, 1e-6));

namespace {

// A plane across the camera's view that sends each ray on: the sky it then sees, against the law in the static frame.
void compare_plane(const char* texture, const std::function<bool(const Vec3& s, const Vec3& n, Vec3& out)>& law) {
	// The hole stands on the camera's side of the plane p.n = c, and to the side of the view.
	const Vec3 n = unit({0.2, 1, 0.1});
	const double c = -2.2;
	const Camera camera({0.5, 3, -7}, {0, -1, 1.2}, 0.05, 16, 12);
	const std::string scene = camera.text() + "sky_sphere { Coordinates(1.01) } plane { " + text_of(n) + ", " + number(c) + " " +
							  texture + " } blackhole { 0, 1 tolerance 1e-7 }";
	const Seen seen = see(scene, 1.01, camera.width, camera.height);
	ASSERT_FALSE(seen.values.empty());
	const auto surface = [&](const Vec3& p) { return dot(p, n) - c; };
	double worst = 0, without = 0;
	int compared = 0;
	for (int j = 0; j < camera.height; j++)
		for (int i = 0; i < camera.width; i++) {
			const Vec3 x = camera.location, d = camera_direction(x, camera.pixel(i, j));
			Vec3 point, tangent, again, t2, leaves, direction, position;
			if (!oracle::first_hit(x, d, last, surface, point, tangent))
				continue;
			const double f = g(length(point));
			const Vec3 in = unit(radial_times(point, tangent, 1 / f)), normal = unit(radial_times(point, n, f));
			if (!law(in, normal, leaves))
				continue;
			const Vec3 out = unit(radial_times(point, leaves, f));
			if (oracle::first_hit(point, out, last, surface, again, t2))
				continue; // comes back to the plane: another story
			double b;
			if (!oracle::exit_direction(point, out, R, direction, position, &b) || std::fabs(b / critical_b - 1) < 0.02)
				continue;
			compared++;
			worst = std::max(worst, length(direction - seen.at(i, j)));
			// What the ordinary law in coordinates would have given.
			Vec3 naive;
			if (law(unit(tangent), n, naive) && oracle::exit_direction(point, naive, R, direction, position))
				without = std::max(without, length(direction - seen.at(i, j)));
		}
	std::printf(
		"%s: worst %.2e rad on %d pixels (the law in coordinates would be off by %.2e)\n", texture, worst, compared, without);
	EXPECT_GT(compared, 40);
	// Two segments of tolerance 1e-7, the second from a point that the first moved: the plane is met at up to 70 degrees,
	// and a ray at 2 % of b_c multiplies what it starts with by about 50.
	EXPECT_LT(worst, 5e-6);
	EXPECT_GT(without, 1e-2);
}

} // namespace

TEST(Mirror, ReflectsInTheStaticFrame) {
	compare_plane("pigment { rgb 0 } finish { reflection 1 diffuse 0 ambient 0 }", [](const Vec3& s, const Vec3& n, Vec3& out) {
		out = s - 2 * dot(s, n) * n;
		return true;
	});
}

TEST(Glass, RefractsInTheStaticFrame) {
	compare_plane(
		"pigment { rgbt 1 } finish { diffuse 0 ambient 0 } interior { ior 1.3 }", [](const Vec3& s, const Vec3& n, Vec3& out) {
			const double c = -dot(s, n), eta = 1 / 1.3, k = 1 - eta * eta * (1 - c * c);
			out = eta * s + (eta * c - std::sqrt(k)) * n;
			return c > 0;
		});
}

// Light goes straight for now; it is dark where its way meets the horizon, and only there.
TEST(Light, IsStraightAndBlockedByTheHorizon) {
	const int n = 61;
	const Camera camera({0, 30, 0}, {0, -1, 0.0001}, 0.006, n, n);
	const std::string scene = camera.text() + "plane { y, -3 pigment { rgb 1 } finish { ambient 0 diffuse 1 } } "
											  "light_source { <0, 20, 0> rgb 1 } ";
	const Rendering with = povray(scene + "blackhole { <0, 2, 0>, 1 camera \"coordinate\" effect_radius 3 }", n, n);
	ASSERT_FALSE(with.picture.samples.empty()) << with.text;
	// The shadow's cone: half-angle asin(1 / 18) from the light 20 above, on a floor 23 below it.
	const double radius = 23 * std::tan(std::asin(1.0 / 18));
	int dark = 0, wrong = 0;
	for (int j = 0; j < n; j++)
		for (int i = 0; i < n; i++) {
			const Vec3 d = camera.pixel(i, j);
			// Rays that pass outside the effect sphere are straight.
			const Vec3 p = camera.location + ((-3 - camera.location.y) / d.y) * d;
			const double off = std::hypot(p.x, p.z);
			dark += with.picture.black(i, j);
			const double pass = std::hypot((p.x - camera.location.x) * (28.0 / 33), (p.z - camera.location.z) * (28.0 / 33));
			if (pass > 3.2 && with.picture.black(i, j) != (off < radius))
				wrong++;
		}
	EXPECT_GT(dark, 20);
	EXPECT_EQ(wrong, 0);
}

// A hole between a light and a lens: the caustic is gone, as the light itself is.
TEST(Light, PhotonsEndInTheHorizon) {
	const std::string scene =
		Camera({0, -1, -8}, {0, -1.6, 8}, 0.02, 20, 10).text() +
		"global_settings { photons { count 4000 } } light_source { <0, 20, 0> rgb 1 } "
		"sphere { 0, 1 pigment { rgbt 1 } finish { ambient 0 diffuse 0 } interior { ior 1.5 } "
		"photons { target refraction on } } plane { y, -3 pigment { rgb 1 } finish { ambient 0 diffuse 1 } } ";
	const Rendering without = povray(scene, 20, 10),
					with = povray(scene + "blackhole { <0, 10, 0>, 1 effect_radius 1.6 }", 20, 10);
	ASSERT_FALSE(without.picture.samples.empty()) << without.text;
	ASSERT_FALSE(with.picture.samples.empty()) << with.text;
	double brightest = 0, in_shadow = 0;
	for (int x = 8; x < 12; x++) {
		brightest = std::max(brightest, without.picture.at(x, 5, 0));
		in_shadow = std::max(in_shadow, with.picture.at(x, 5, 0));
	}
	EXPECT_GT(brightest, 0.5);
	EXPECT_EQ(in_shadow, 0);
}
