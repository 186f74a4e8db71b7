// SPDX-License-Identifier: AGPL-3.0-or-later
/// What was claimed in 1999 about pictures: the scenes that show it are rendered small, with and without their hole, and pixels
/// counted.
#include "povray.h"
#include "blackhole/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

namespace {

Rendering render(const std::string& name, int width, int height, const std::string& words = "") {
	std::ifstream in(std::string(SCENES) + "/" + name + ".pov");
	const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
	EXPECT_FALSE(text.empty()) << name;
	const Rendering run = povray(text, width, height, words);
	EXPECT_EQ(run.exit_code, 0) << run.text;
	EXPECT_FALSE(run.picture.samples.empty());
	return run;
}
Picture scene(const std::string& name, int width, int height, const std::string& words = "") {
	return render(name, width, height, words).picture;
}

// Pixels whose red, green and blue are of a kind.
int count(const Picture& p, const std::function<bool(double, double, double)>& kind) {
	int n = 0;
	for (int y = 0; y < p.height; y++)
		for (int x = 0; x < p.width; x++)
			n += kind(p.at(x, y, 0), p.at(x, y, 1), p.at(x, y, 2));
	return n;
}

bool red(double r, double g, double b) { return r > 0.05 && r > 4 * g && r > 4 * b; }
bool green(double r, double g, double b) { return g > 0.05 && g > 1.8 * r && g > 1.8 * b; }

constexpr double pi = 3.14159265358979323846;

struct Graze {
	double angle;  // off straight in, in coordinates
	double radius; // where it turns
};

// The ray from r0 that has swept so much where it turns: a larger sphere hides the place below, a smaller one shows more.
Graze graze(double r0, double sweep) {
	double a = 0, b = pi / 2; // captured, passing
	for (int i = 0; i < 100; i++) {
		const double middle = (a + b) / 2;
		const oracle::Ray ray(r0, pi - oracle::Real(middle));
		(!ray.turns() || ray.turning_angle() > sweep ? a : b) = middle;
	}
	return {b, double(oracle::Ray(r0, pi - oracle::Real(b)).turning_radius())};
}

} // namespace

// 1999: from anywhere one sees all of a sphere round the hole. Of a small one only.
TEST(Claims, AllOfASurfaceIfItIsSmall) {
	EXPECT_NEAR(graze(1e6, pi).radius, 1.7603, 0.5e-4) << "the figure in whole_surface.pov";
	EXPECT_NEAR(graze(500, pi).radius, 1.7586, 0.5e-4) << "the figure in whole_surface.pov";
	EXPECT_NEAR(graze(500, 166.65 * pi / 180).radius, 1.85, 1e-3) << "the figure in whole_surface.pov";
	EXPECT_NEAR(graze(500, 192.02 * pi / 180).radius, 1.70, 1e-3) << "the figure in whole_surface.pov";
	const auto gold = [](double r, double g, double b) { return !red(r, g, b) && r > 2 * b && r > 0.3; };
	const Picture small = scene("whole_surface", 320, 180), large = scene("whole_surface", 320, 180, "Declare=Radius=1.85"),
				  none = scene("whole_surface", 320, 180, "Blackhole=off");
	EXPECT_GT(count(small, red), 100) << "the far pole, all round the rim";
	EXPECT_EQ(count(large, red), 0) << "the far pole is out of sight";
	EXPECT_EQ(count(none, red), 0);
	EXPECT_GT(count(small, gold), 2000) << "of the far half";
	EXPECT_GT(count(large, gold), 2000);
	EXPECT_LT(count(none, gold), 100) << "only stars";
}

// The limit itself, through a telescope at the rim: a cap of one degree at the far pole of spheres 0.4 % smaller and larger.
TEST(Claims, TheLimitOfASmallSphere) {
	const Graze rim = graze(500, pi);
	const std::string camera = "camera { location <0, 0, -500> direction <" + number(std::sin(rim.angle)) + ", 0, " +
							   number(std::cos(rim.angle)) + "> right 3e-5*x up 2e-5*y } ";
	const auto cap = [&](double radius) {
		const Picture p = povray(
			camera + "sphere { 0, 1 pigment { gradient z color_map { [" + number((1 + std::cos(pi / 180)) / 2) + " rgb y] [" +
				number((1 + std::cos(pi / 180)) / 2) + " rgb x] } scale 2 translate -z } scale " + number(radius) +
				" finish { emission 1 ambient 0 diffuse 0 } } " + "blackhole { 0, 1 tolerance 1e-6 camera \"coordinate\" }",
			60, 40)
							  .picture;
		EXPECT_GT(count(p, green), 200) << "the sphere's rim is in the picture";
		EXPECT_GT(count(p, [](double r, double g, double b) { return r + g + b == 0; }), 200);
		return count(p, red);
	};
	EXPECT_GT(cap(0.996 * rim.radius), 10);
	EXPECT_EQ(cap(1.004 * rim.radius), 0);
}

// 1999: looking along the horizon one sees the back of one's head, several times, also off the horizon line.
TEST(Claims, TheBackOfOnesHead) {
	// Light that starts 1 mrad above the circle, after a turn; 1 mrad by a static observer's protractor.
	const oracle::Ray ray(1.5, pi / 2 - std::atan(1e-3 * std::sqrt(1 - 1 / 1.5)));
	EXPECT_NEAR(double(ray.swept(1.5L + 0.2584L, 0)), 2 * pi, 0.01) << "the figure in back_of_head.pov";
	const auto brown = [](double r, double g, double b) { return r > 1.8 * g && r > 3 * b && !red(r, g, b); };
	const Picture there = scene("back_of_head", 96, 54), none = scene("back_of_head", 96, 54, "Blackhole=off");
	EXPECT_GT(count(there, red), 100) << "the cap";
	EXPECT_GT(count(there, brown), 300) << "the hair";
	EXPECT_EQ(count(none, red), 0) << "the head is behind the camera";
	EXPECT_EQ(count(none, brown), 0);
	// Not only on the circle: along the shadow's edge, which the picture's middle column crosses.
	for (const double r : {1.3, 3.0, 6.0}) {
		const std::string words = "Declare=R=" + number(r);
		const Picture p = scene("back_of_head", 96, 54, words);
		EXPECT_GT(count(p, brown), 50) << "at " << r;
		if (r != 3)
			continue;
		int edge = 0, top = 54, bottom = 0;
		for (int y = 53; y >= 0; y--) {
			if (p.black(48, y))
				edge = y;
			if (brown(p.at(48, y, 0), p.at(48, y, 1), p.at(48, y, 2))) {
				top = y;
				bottom = std::max(bottom, y + 1);
			}
		}
		EXPECT_NEAR((edge - bottom) * 35.0 / 96, 4.6, 0.6) << "mrad, the figure in back_of_head.pov";
		EXPECT_NEAR((edge - top) * 35.0 / 96, 6.2, 0.6) << "mrad, the figure in back_of_head.pov";
	}
	EXPECT_EQ(count(scene("back_of_head", 96, 54, "Declare=R=3 Blackhole=off"), brown), 0);
}

// 1999: a table's top and bottom at once.
TEST(Claims, ATablesTopAndBottom) {
	const Picture both = scene("table", 160, 90), none = scene("table", 160, 90, "Blackhole=off");
	EXPECT_GT(count(both, green), 300) << "the top";
	EXPECT_GT(count(both, red), 300) << "the underside";
	EXPECT_GT(count(none, green), 20);
	EXPECT_EQ(count(none, red), 0);
}

// 1999: nothing inside the Schwarzschild radius may be visible.
TEST(Claims, NothingInside) {
	EXPECT_EQ(count(scene("nothing_inside", 320, 180), red), 0);
	EXPECT_GT(count(scene("nothing_inside", 320, 180, "Blackhole=off"), red), 300);
	// Neither to somebody who is inside himself.
	const std::string inside =
		"camera { location <0, 0, -0.6> direction x/2 up y right -4/3*z } sphere { <0.6, 0, -0.5>, 0.2 pigment { rgb x } finish "
		"{ emission 1 "
		"ambient 0 diffuse 0 } } sphere { 0, 9 pigment { rgb y } finish { emission 1 ambient 0 diffuse 0 } } "
		"blackhole { 0, 1 camera \"falling\" }";
	const Picture there = povray(inside, 80, 60).picture, none = povray(inside, 80, 60, "Blackhole=off").picture;
	EXPECT_EQ(count(there, red), 0);
	EXPECT_GT(count(none, red), 300);
	EXPECT_GT(count(there, green), 100) << "what is outside is seen";
}

// 1999: playing god. Each scene is loaded, bends rays and is not black; of a film, its last frame.
TEST(Claims, EveryScene) {
	int scenes = 0, films = 0;
	for (const auto& entry : std::filesystem::directory_iterator(SCENES)) {
		if (entry.path().extension() != ".pov")
			continue;
		const std::string name = entry.path().stem().string();
		scenes++;
		films += std::filesystem::exists(std::filesystem::path(entry).replace_extension(".ini"));
		const Rendering run = render(name, 24, 14, "+K1 Declare=Tol=1e-2");
		EXPECT_NE(run.text.find("Bent Rays: "), std::string::npos) << name << run.text;
		EXPECT_GT(count(run.picture, [](double r, double g, double b) { return r + g + b > 0.001; }), 24) << name;
	}
	EXPECT_GE(scenes, 12);
	EXPECT_EQ(films, 3);
}
