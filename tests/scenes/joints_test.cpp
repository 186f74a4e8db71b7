// SPDX-License-Identifier: AGPL-3.0-or-later
/// Where one chord ends and the next begins, and where a ray leaves a surface: nothing is missed, nothing is hit twice.
#include "coordinates.h"
#include "blackhole/orbit.h"
#include "blackhole/oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

using namespace blackhole;

namespace {

constexpr int w = 120, h = 90;
const std::string view = "camera { location <0, 1, -14> look_at 0 angle 40 } ";
const std::string hole = "blackhole { 0, 1 effect_radius 40 tolerance 1e-3 camera \"coordinate\" } ";

// Every pixel's joints inside the effect sphere and the direction of the chord that ends there, as povray itself wrote them.
struct Joint {
	Vec3 at, along;
};
std::vector<std::vector<Joint>> joints() {
	const Rendering run =
		povray(view + hole, w, h, "Ray_Paths=p.csv Ray_Paths_Grid=" + std::to_string(w) + "x" + std::to_string(h));
	std::vector<std::vector<Joint>> list(std::size_t(w * h));
	std::ifstream in(run.folder + "/p.csv");
	std::string line;
	std::getline(in, line);
	while (std::getline(in, line)) {
		std::stringstream s(line);
		double f[12];
		char comma;
		for (double& v : f)
			s >> v >> comma;
		const Vec3 from{f[6], f[7], f[8]}, to{f[9], f[10], f[11]};
		if (f[5] == 0 && length(to) > 1.1)
			list[std::size_t(f[1] * w + f[0])].push_back({to, unit(to - from)});
	}
	return list;
}

// How many pixels that have a k-th joint do not see the thing put there; things: how many there were.
int missed(const std::vector<std::vector<Joint>>& all, std::size_t k, const std::function<std::string(const Joint&, int)>& thing,
	int& things) {
	std::ostringstream scene;
	scene.precision(17);
	std::vector<int> has(all.size());
	int n = 0;
	for (std::size_t i = 0; i < all.size(); i++)
		if (all[i].size() > k) {
			has[i] = 1;
			scene << thing(all[i][k], n++) << "\n";
		}
	things += n;
	const Rendering run =
		povray(view + hole + "#default { pigment { rgb 1 } finish { emission 1 ambient 0 diffuse 0 } }\n" + scene.str(), w, h);
	if (run.picture.samples.empty()) {
		ADD_FAILURE() << run.text;
		return n;
	}
	int miss = 0;
	for (int y = 0; y < h; y++)
		for (int x = 0; x < w; x++)
			miss += has[std::size_t(y * w + x)] && run.picture.black(x, y);
	return miss;
}

} // namespace

// A hundred thousand tries, of four kinds: a ball of 1e-3 Rs around the joint, one whose near or whose far side is at the
// joint, and a disc right there.
TEST(Joints, NothingSmallIsMissed) {
	const auto all = joints();
	const auto thing = [](const Joint& j, int n) {
		const double size = 1e-3;
		const Vec3 centre = j.at + (n % 4 == 1 ? size : n % 4 == 2 ? -size : 0) * j.along;
		return n % 4 == 3 ? "disc { " + text_of(j.at) + ", " + text_of(j.along) + ", 1e-3 }"
						  : "sphere { " + text_of(centre) + ", 1e-3 }";
	};
	int tries = 0, miss = 0;
	for (std::size_t k = 0; k < 12; k++)
		miss += missed(all, k, thing, tries);
	std::printf("%d joints, %d missed\n", tries, miss);
	EXPECT_GE(tries, 100000);
	EXPECT_EQ(miss, 0);
}

// The test above can fail: beside the path nothing is seen.
TEST(Joints, BesideThePathNothingIsHit) {
	const auto all = joints();
	int tries = 0;
	const int miss = missed(
		all, 4,
		[](const Joint& j, int) {
			const Vec3 aside = unit(cross(j.along, std::fabs(j.along.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
			return "sphere { " + text_of(j.at + 3e-3 * aside) + ", 1e-3 }";
		},
		tries);
	EXPECT_GT(miss, tries * 9 / 10);
}

// An isosurface takes a start within some accuracies of it for its own: with coarse ones, a joint in a hundred is so near.
TEST(Joints, IsosurfacesAreNotMissed) {
	const std::string scene =
		"camera { location <0, 2, -14> look_at 0 angle 45 } #for (I, 0, 7) isosurface { function { x*x + y*y + z*z - 1 } "
		"max_gradient 5 accuracy 0.01 contained_by { sphere { 0, 1.4 } } scale 1.3 pigment { rgb 1 } finish { emission 1 "
		"ambient 0 diffuse 0 } translate <4*cos(I*pi/4), 0.5*sin(I), 4*sin(I*pi/4)> } #end ";
	const Rendering twin = povray(scene, 160, 120),
					many = povray(scene + "blackhole { 0, 1e-5 effect_radius 30 tolerance 1e-9 }", 160, 120);
	ASSERT_FALSE(many.picture.samples.empty()) << many.text;
	int seen = 0, missing = 0;
	for (int y = 0; y < 120; y++)
		for (int x = 0; x < 160; x++) {
			seen += !twin.picture.black(x, y);
			missing += !twin.picture.black(x, y) && many.picture.black(x, y);
		}
	std::printf("%d pixels of isosurface, %d missing\n", seen, missing);
	EXPECT_GT(seen, 5000);
	EXPECT_LE(missing, seen / 1000); // on silhouettes: those are no sharper than the accuracy
}

namespace {

constexpr double R = 30;
double g(double r) { return std::sqrt((1 - 1 / r) / (1 - 1 / R)); }

// Whether the exact path of a pixel that meets the surface is black once reflected: it meets it again, or ends in the hole;
// positions from the hole's centre.
bool is_black(const Vec3& x, const Vec3& d, const std::function<double(const Vec3&)>& surface,
	const std::function<Vec3(const Vec3&)>& normal) {
	Vec3 point, tangent, again;
	if (!oracle::first_hit(x, d, R, surface, point, tangent))
		return false;
	const double f = g(length(point));
	const Vec3 in = unit(radial_times(point, tangent, 1 / f)), n = unit(radial_times(point, normal(point), f));
	const Vec3 out = unit(radial_times(point, in - 2 * dot(in, n) * n, f));
	Vec3 direction, position;
	return oracle::first_hit(point, out, R, surface, again, tangent) ||
		   !oracle::exit_direction(point, out, R, direction, position);
}

} // namespace

// A surface seen along itself, all in mirror: white is the sky, black what was reflected twice (max_trace_level 2) or
// into the hole. Off a ball round the hole neither ever is; off a plane the exact path says.
TEST(Grazing, NoSurfaceIsHitByWhatItReflects) {
	std::string mesh = "mesh { ";
	for (int i = -14; i < 14; i++)
		for (int j = -14; j < 14; j++)
			for (int k = 0; k < 2; k++) {
				const auto p = [&](int a, int b) { return text_of({a * 3.0, -4, b * 3.0}); };
				mesh += "triangle { " + p(i, j) + "," + p(i + 1, j + 1) + "," + (k ? p(i + 1, j) : p(i, j + 1)) + " } ";
			}
	mesh += "rotate <0, 13, 0> ";
	const auto floor = [](const Vec3& p) { return p.y + 4; };
	const auto up = [](const Vec3&) { return Vec3{0, 1, 0}; };
	const struct {
		const char* name;
		Camera camera;
		std::string mirror;
		std::function<double(const Vec3&)> surface;
		std::function<Vec3(const Vec3&)> normal;
	} cases[] = {
		{"ball r = 3", Camera({0, 3.2, -5}, {0, -0.3, 5}, 0.018, 40, 27), "sphere { 0, 3 ", nullptr, nullptr},
		{"ball r = 1.6", Camera({0, 1.7, -4}, {0, -0.2, 4}, 0.018, 40, 27), "sphere { 0, 1.6 ", nullptr, nullptr},
		{"plane under the hole", Camera({0, -3.98, -12}, {0, -0.02, 12}, 0.018, 40, 27), "plane { y, -4 ", floor, up},
		{"mesh under the hole", Camera({0, -3.98, -12}, {0, -0.02, 12}, 0.018, 40, 27), mesh, floor, up},
	};
	for (const auto& c : cases) {
		std::vector<int> expected;
		for (int y = 0; y < c.camera.height; y++)
			for (int x = 0; x < c.camera.width; x++)
				expected.push_back(c.normal && is_black(c.camera.location, c.camera.pixel(x, y), c.surface, c.normal));
		for (const char* tolerance : {"1e-2", "1e-3", "1e-4", "1e-6"}) {
			const std::string scene =
				c.camera.text() + "sky_sphere { pigment { rgb 1 } } global_settings { max_trace_level 2 } " +
				"blackhole { 0, 1 camera \"coordinate\" effect_radius 30 tolerance " + tolerance + " } " + c.mirror;
			const Rendering seen =
								povray(scene + "pigment { rgb <0, 1, 0> } finish { emission 1 ambient 0 diffuse 0 } }", 40, 27),
							run = povray(scene + "pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection 1 } }", 40, 27);
			ASSERT_FALSE(run.picture.samples.empty()) << run.text;
			int mirror = 0, twice = 0, right = 0;
			for (int y = 0; y < 27; y++)
				for (int x = 0; x < 40; x++)
					if (seen.picture.at(x, y, 0) == 0 && seen.picture.at(x, y, 1) > 0.9) {
						mirror++;
						const bool again = run.picture.black(x, y);
						twice += again;
						right += again == bool(expected[std::size_t(y * 40 + x)]);
					}
			std::printf("%-20s tolerance %s: %d pixels of mirror, %d black, %d as they should\n", c.name, tolerance, mirror,
				twice, right);
			EXPECT_GT(mirror, 200) << c.name;
			// At the coarsest, the edge of what is seen in the mirror is off by some of a pixel, 0.018.
			EXPECT_GE(right, tolerance == std::string("1e-2") ? mirror - 6 : mirror) << c.name << " " << tolerance;
		}
	}
}
