// SPDX-License-Identifier: AGPL-3.0-or-later
/// A hole of any size is the same hole: from 1e-9 to 1e9 scene units, and with an effect sphere of next to nothing.
#include "coordinates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using blackhole::Vec3;

namespace {

// The largest difference between what two pictures show, and how many pixels are black in one only.
double differ(const Seen& a, const Seen& b, int& black) {
	double most = 0;
	black = 0;
	for (std::size_t i = 0; i < a.values.size(); i++) {
		black += a.black[i] != b.black[i];
		if (!a.black[i] && !b.black[i])
			most = std::max(most, length(a.values[i] - b.values[i]));
	}
	return most;
}

Camera camera(double rs) { return Camera({0.3 * rs, rs, -15 * rs}, {-0.3, -1, 15}, 0.015, 48, 36); }

// paths: something in reach, behind the camera, so that paths are followed.
Seen sky(double rs, const std::string& hole, bool paths) {
	return see(camera(rs).text() + "sky_sphere { Coordinates(1) } blackhole { 0, " + number(rs) + " " + hole + " }" +
				   (paths ? " sphere { -500*z*" + number(rs) + ", 1e-3*" + number(rs) + " }" : ""),
		1, 48, 36);
}

} // namespace

// A direction of 16 bits and 1024 steps is read back to 4e-8.
TEST(Sizes, TheSkyIsTheSameForEverySize) {
	for (const char* hole : {"", "method \"rk4\"", "method \"dopri5\"", "method \"exact\""}) {
		const bool paths = *hole;
		const Seen one = sky(1, hole, paths);
		for (double rs : {1e-9, 1e-5, 1e3, 1e9}) {
			int black;
			const double most = differ(one, sky(rs, hole, paths), black);
			std::printf("Rs %g, %s: the sky differs by %.1e, %d pixels by their outcome\n", rs, hole, most, black);
			EXPECT_LT(most, 1e-7) << rs << " " << hole;
			EXPECT_EQ(black, 0) << rs << " " << hole;
		}
	}
}

// With objects, where POV-Ray's own lengths allow; beyond, it says so.
TEST(Sizes, ObjectsAreWhereTheyWere) {
	const auto with = [](double rs) {
		const std::string s = number(rs);
		return see(camera(rs).text() + "union { #for (I, 0, 6) sphere { <4*cos(I), sin(3*I), 4*sin(I)>, 0.8 } #end scale " + s +
					   " texture { Coordinates(6*" + s + ") finish { emission 1 ambient 0 diffuse 0 } } } blackhole { 0, " + s +
					   " tolerance 1e-4 }",
			6 * rs, 48, 36);
	};
	const Seen one = with(1);
	int seen = 0;
	for (bool b : one.black)
		seen += !b;
	EXPECT_GT(seen, 150);
	for (double rs : {1e-2, 1e4}) {
		Seen other = with(rs);
		for (Vec3& v : other.values)
			v = (1 / rs) * v;
		int black;
		const double most = differ(one, other, black);
		std::printf("Rs %g: %d pixels of spheres, places differ by %.1e, %d pixels by their outcome\n", rs, seen, most, black);
		EXPECT_LT(most, 1e-6) << rs;
		EXPECT_EQ(black, 0) << rs;
	}
}

// Where the effect sphere is next to none, rays are straight but for the last half of a Schwarzschild radius; and nothing fails.
TEST(Sizes, AnEffectSphereOfNextToNothing) {
	for (const char* method : {"rk4", "dopri5", "exact"})
		for (const char* beyond : {"1e-15", "1e-9", "1e-3"}) {
			const std::string scene = "camera { location -15*z look_at 0 angle 16 } sky_sphere { pigment { rgb 1 } } "
									  "sphere { 4*z, 1 pigment { rgb x } finish { emission 1 diffuse 0 ambient 0 } } "
									  "blackhole { 0, 1 camera \"coordinate\" method \"" +
									  std::string(method) + "\" effect_radius 1.5 + " + beyond + " }";
			const Rendering run = povray(scene, 80, 60);
			ASSERT_FALSE(run.picture.samples.empty()) << run.text;
			EXPECT_EQ(run.text.find("Warning:"), std::string::npos) << run.text;
			// On the photon sphere all that goes inward is captured: all of a disc of radius 1.5 is black, and nothing else.
			int wrong = 0;
			for (int y = 0; y < 60; y++)
				for (int x = 0; x < 80; x++) {
					const double scale = 2 * std::tan(8 * std::acos(-1.0) / 180) / 80;
					const double px = (x - 39.5) * scale, py = (y - 29.5) * scale, size = std::sqrt(1 + px * px + py * py);
					const double b = 15 * std::hypot(px, py) / size;
					if (std::fabs(b - 1.5) > 0.01)
						wrong += run.picture.black(x, y) != (b < 1.5);
				}
			EXPECT_EQ(wrong, 0) << method << " " << beyond;
		}
}

// Coordinates that cannot hold the tolerance are a warning that says which one they can.
TEST(Sizes, FarFromTheOriginIsNamed) {
	const auto says = [](const char* center, const char* hole) {
		const std::string c = center;
		std::string text = povray("camera { location " + c + " - 15*z look_at " + c + " } sphere { " + c +
									  " + 3*x, 1 pigment { rgb 1 } } blackhole { " + c + ", 1 " + hole + " }",
			8, 6)
							   .text;
		text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
		return text;
	};
	EXPECT_EQ(says("<1e7, 0, 0>", "tolerance 1e-8").find("so far from the origin"), std::string::npos);
	EXPECT_NE(
		says("<1e7, 0, 0>", "tolerance 1e-9").find("no method keeps tolerance 1e-09 there; 6e-09 can be kept"), std::string::npos)
		<< says("<1e7, 0, 0>", "tolerance 1e-9");
	EXPECT_EQ(says("<0, 0, 0>", "effect_radius 1e9").find("so large that coordinates"), std::string::npos);
	EXPECT_NE(
		says("<0, 0, 0>", "effect_radius 1e10").find("do not tell where rays go to its tolerance, 0.0001: they do to 0.0004"),
		std::string::npos)
		<< says("<0, 0, 0>", "effect_radius 1e10");
}

// POV-Ray takes negative radii for what they are without the sign; so must those that look whether a ray comes near, however many
// objects there are.
TEST(Sizes, TheSignOfASpheresRadiusMeansNothing) {
	const auto spheres = [](const char* sign, int count) {
		std::string text = "camera { location <0, 0, -20> look_at 0 angle 50 } blackhole { 0, 1 effect_radius 60 }\n";
		for (int i = 0; i < count; i++) {
			const std::string turn = std::to_string(37 * i), shade = number((i % 7 + 1) / 8.0);
			text += "sphere { vrotate(<4, 0, 0>, <0, " + turn + ", 2*" + turn + ">), " + sign + number(count > 100 ? 0.2 : 1.2) +
					" pigment { rgb <1, " + shade + ", 0> } finish { ambient 1 diffuse 0 } }\n";
		}
		return povray(text, 64, 48).picture;
	};
	for (const int count : {1, 7, 200}) {
		const Picture positive = spheres("", count);
		ASSERT_FALSE(positive.samples.empty());
		int seen = 0;
		for (int i = 0; i < 64 * 48; i++)
			seen += !positive.black(i % 64, i / 64);
		EXPECT_GT(seen, 50) << count;
		EXPECT_TRUE(positive == spheres("-", count)) << count;
	}
}
