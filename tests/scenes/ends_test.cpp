// SPDX-License-Identifier: AGPL-3.0-or-later
/// What bhtrade builds on: keys that set every hole's settings, where rays end, and a sample of a picture's blocks.
#include "coordinates.h"
#include "blackhole/oracle.h"
#include "blackhole/orbit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

using blackhole::Vec3;

namespace {

const std::string sky = "sky_sphere { pigment { checker rgb 0.2 rgb 1 scale 0.3 } }\n";
const std::string camera = "camera { location <0, 1, -15> look_at <0, 0, 0> }\n" + sky;
const std::string objects = "sphere { <3, 0, 3>, 1 pigment { rgb y } finish { reflection 0.5 ambient 1 } }\n"
							"sphere { <-3, 0, 2>, 1.5 pigment { rgb 1 } finish { ambient 1 } }\n"
							"plane { y, -4 pigment { checker rgb 0.1 rgb 1 } finish { ambient 1 } }\n";

struct End {
	int level, object;
	double weight;
	std::string end;
	Vec3 at;
};

std::map<std::pair<int, int>, std::vector<End>> read_ends(const std::string& file, std::string* holes = nullptr) {
	std::map<std::pair<int, int>, std::vector<End>> ends;
	std::ifstream in(file);
	for (std::string line; std::getline(in, line);) {
		if (line[0] == '#' && holes)
			*holes += line + "\n";
		if (line[0] == '#' || line[0] == 'c')
			continue;
		std::vector<std::string> f;
		std::stringstream s(line);
		for (std::string cell; std::getline(s, cell, ',');)
			f.push_back(cell);
		if (f.size() != 10) {
			ADD_FAILURE() << line;
			continue;
		}
		ends[{std::stoi(f[0]), std::stoi(f[1])}].push_back(
			{std::stoi(f[3]), std::stoi(f[6]), std::stod(f[4]), f[5], {std::stod(f[7]), std::stod(f[8]), std::stod(f[9])}});
	}
	return ends;
}

double value(const std::string& text, const std::string& label) {
	const std::size_t at = text.find(label);
	return at == std::string::npos ? -1 : std::strtod(text.c_str() + at + label.size(), nullptr);
}

} // namespace

TEST(Overrides, SayWhatTheSceneCouldSay) {
	const std::string words = "Blackhole_Tolerance=1e-2 Blackhole_Method=exact Blackhole_Effect_Radius=12";
	const Rendering plain = povray(camera + objects + "blackhole { 0, 1 }", 48, 36);
	const Rendering keys = povray(camera + objects + "blackhole { 0, 0.5 tolerance 1e-6 scale 2 }", 48, 36, words);
	const Rendering scene =
		povray(camera + objects + "blackhole { 0, 1 tolerance 1e-2 method \"exact\" effect_radius 12 }", 48, 36);
	ASSERT_FALSE(scene.picture.samples.empty()) << scene.text;
	EXPECT_TRUE(keys.picture == scene.picture) << keys.text;
	EXPECT_FALSE(keys.picture == plain.picture) << "or the keys do nothing";
}

TEST(Overrides, AreForEveryHole) {
	const std::string place = "blackhole { <-5, 0, 0>, 1 effect_radius 4 } blackhole { <5, 0, 0>, 0.5 effect_radius 2 }";
	const std::string said = "blackhole { <-5, 0, 0>, 1 effect_radius 6 tolerance 1e-3 } "
							 "blackhole { <5, 0, 0>, 0.5 effect_radius 3 tolerance 1e-3 }";
	const Rendering keys = povray(camera + objects + place, 48, 36, "Blackhole_Effect_Radius=6 Blackhole_Tolerance=1e-3");
	ASSERT_FALSE(keys.picture.samples.empty()) << keys.text;
	EXPECT_TRUE(keys.picture == povray(camera + objects + said, 48, 36).picture);
	EXPECT_FALSE(keys.picture == povray(camera + objects + place, 48, 36).picture);
	const Rendering wide = povray(camera + place, 8, 6, "Blackhole_Effect_Radius=7");
	EXPECT_NE(wide.exit_code, 0);
	EXPECT_NE(joined(wide.text).find("overlap"), std::string::npos) << wide.text;
}

TEST(Overrides, BadValuesAreRefused) {
	const struct {
		const char *words, *says;
	} bad[] = {{"Blackhole_Tolerance=0.2", "Blackhole_Tolerance=0.2: must be between 1e-9 and 0.1"},
		{"Blackhole_Tolerance=fine", "Blackhole_Tolerance=fine: must be"}, {"Blackhole_Tolerance=nan", "must be between"},
		{"Blackhole_Method=euler", "Blackhole_Method=euler: must be one of rk4, dopri5, exact"},
		{"Blackhole_Effect_Radius=1.5", "Blackhole_Effect_Radius=1.5: must be above 1.5"},
		{"Blackhole_Effect_Radius=1e13", "at most 1e12"}, {"Sample_Blocks=0", "Sample_Blocks=0: must be a whole number"},
		{"Sample_Blocks=2.5", "must be a whole number"}, {"Ray_Ends=no/such/folder/e.csv", "cannot write there"}};
	for (const auto& b : bad) {
		const Rendering r = povray(camera + "blackhole { 0, 1 }", 8, 6, b.words);
		EXPECT_NE(r.exit_code, 0) << b.words;
		EXPECT_NE(joined(r.text).find(b.says), std::string::npos) << b.words << "\n" << r.text;
	}
}

// Directions at the sky against exact geodesics; points of objects are on these.
TEST(Ray_Ends, AreWhereRaysEnd) {
	const int w = 32, h = 24;
	const Vec3 eye{0, 1, -15};
	const Camera view(eye, {0, -0.05, 1}, 0.03, w, h);
	const double R = 1000, tolerance = 1e-6;
	const Rendering run =
		povray(view.text() + sky + objects + "blackhole { 0, 1 effect_radius 1000 tolerance 1e-6 }", w, h, "Ray_Ends=e.csv");
	std::string holes;
	const auto ends = read_ends(run.folder + "/e.csv", &holes);
	EXPECT_EQ(holes.rfind("# hole 0 0 0 Rs 1 effect_radius 1000 tolerance 9.9999999999999995e-07 method rk4\n", 0), 0u) << holes;
	ASSERT_EQ(ends.size(), std::size_t(w * h)) << run.text;
	std::map<std::string, int> seen;
	int mirrored = 0;
	for (const auto& [pixel, rays] : ends) {
		const End& first = rays[0];
		EXPECT_EQ(first.level, 1);
		EXPECT_EQ(first.weight, 1);
		seen[first.end]++;
		EXPECT_EQ(rays.size(), first.object == 0 ? rays.size() : 1u) << "only the first sphere mirrors";
		if (rays.size() > 1) {
			EXPECT_EQ(rays[1].level, 2);
			EXPECT_EQ(rays[1].weight, 0.5);
			mirrored++;
		}
		if (first.end == "sky") {
			Vec3 direction, position;
			double b = 0;
			// The oracle knows of the hole alone, so only of rays that come out: these met nothing.
			const Vec3 d =
				radial_times(eye, view.pixel(pixel.first, pixel.second), std::sqrt((1 - 1 / length(eye)) / (1 - 1 / R)));
			ASSERT_TRUE(oracle::exit_direction(eye, d, R, direction, position, &b));
			if (std::fabs(b / blackhole::critical_b - 1) > 1e-3) {
				EXPECT_LT(length(direction - first.at), tolerance);
			}
		} else if (first.end == "object") {
			const double off = first.object == 0   ? length(first.at - Vec3{3, 0, 3}) - 1
							   : first.object == 1 ? length(first.at - Vec3{-3, 0, 2}) - 1.5
												   : first.at.y + 4;
			EXPECT_NEAR(off, 0, 1e-6) << first.object;
		} else {
			EXPECT_EQ(length(first.at), 0) << first.end;
			EXPECT_EQ(first.object, -1);
		}
	}
	EXPECT_GT(seen["sky"], 50);
	EXPECT_GT(seen["object"], 50);
	EXPECT_GT(seen["horizon"], 5);
	EXPECT_GT(mirrored, 0);
}

// What the straight outside neglects, physics.md's formula for one way out; the sky alone is followed in closed form.
TEST(Ray_Ends, TellWhatTheEffectRadiusNeglects) {
	const int w = 9, h = 7;
	const double r = 300, R = 400;
	const Camera view({0, 0, -r}, {0.5, 0.3, -0.2}, 0.1, w, h);
	const std::string scene = view.text() + sky + "blackhole { 0, 1 camera \"coordinate\" }";
	const Rendering some = povray(scene, w, h, "Ray_Ends=e.csv Blackhole_Effect_Radius=400"),
					all = povray(scene, w, h, "Ray_Ends=e.csv Blackhole_Effect_Radius=1e9");
	const auto near = read_ends(some.folder + "/e.csv"), far = read_ends(all.folder + "/e.csv");
	ASSERT_EQ(near.size(), std::size_t(w * h)) << some.text;
	for (const auto& [pixel, rays] : near) {
		const double b = length(cross(Vec3{0, 0, -r}, view.pixel(pixel.first, pixel.second)));
		const double s = std::sqrt(1 - b * b / (R * R)), neglected = (2 - 3 * s + s * s * s) / b / 2;
		const double off = length(rays[0].at - far.at(pixel)[0].at);
		EXPECT_NEAR(off, neglected, 0.02 * neglected) << "b = " << b << "; the formula is of first order in Rs / b";
	}
}

TEST(Ray_Ends, ChangeNothing) {
	const Rendering with = povray(camera + objects + "blackhole { 0, 1 }", 32, 24, "Ray_Ends=e.csv +A0.1"),
					without = povray(camera + objects + "blackhole { 0, 1 }", 32, 24, "+A0.1");
	EXPECT_TRUE(with.picture == without.picture);
	EXPECT_EQ(read_ends(with.folder + "/e.csv").count({3, 4}), 1u) << "with antialiasing too";
	const Rendering alone = povray(camera + "blackhole { 0, 1 }", 32, 24, "Ray_Ends=e.csv");
	EXPECT_EQ(value(alone.text, "Chords:"), 0) << "the sky alone needs no chords";
	const Rendering off = povray(camera + objects + "blackhole { 0, 1 }", 32, 24, "Ray_Ends=e.csv Blackhole=off");
	EXPECT_EQ(read_ends(off.folder + "/e.csv").size(), 32u * 24u) << "the hole-free twin's rays end somewhere too";
}

// The blocks that are rendered are as in the whole picture, and about as many as asked for, all over it.
TEST(Sample_Blocks, AreOfThePicture) {
	const std::string scene = "camera { location <0, 1, -15> look_at <0, 0, 0> } background { rgb 0.5 }\n" + objects +
							  "blackhole { 0, 1 } global_settings { RADIOSITY }";
	double pretraced = 0;
	for (const char* radiosity : {"", "radiosity { count 10 pretrace_start 0.2 pretrace_end 0.1 always_sample off }"}) {
		std::string text = scene;
		text.replace(text.find("RADIOSITY"), 9, radiosity);
		const Rendering all = povray(text, 96, 72, "+BS8"), some = povray(text, 96, 72, "+BS8 Sample_Blocks=9");
		ASSERT_FALSE(some.picture.samples.empty()) << some.text;
		if (*radiosity)
			pretraced = value(all.text, "Pixels:") - 96 * 72;
		EXPECT_GE(pretraced, *radiosity ? 1 : 0);
		EXPECT_EQ(value(all.text, "Pixels:"), 96 * 72 + pretraced);
		EXPECT_EQ(value(some.text, "Pixels:"), 96 * 72 / 9 + pretraced) << "radiosity's pretrace is of the whole picture";
		if (*radiosity)
			continue; // its pixels depend on those before them
		int upper = 0, left = 0, rendered = 0;
		for (int y = 0; y < 72; y++)
			for (int x = 0; x < 96; x++)
				if (!some.picture.black(x, y)) {
					rendered++;
					upper += y < 36;
					left += x < 48;
					for (int c = 0; c < 3; c++)
						EXPECT_EQ(some.picture.at(x, y, c), all.picture.at(x, y, c));
				}
		EXPECT_GT(rendered, 96 * 72 / 9 / 2);
		EXPECT_GT(upper, rendered / 4);
		EXPECT_LT(upper, 3 * rendered / 4);
		EXPECT_GT(left, rendered / 4);
		EXPECT_LT(left, 3 * rendered / 4);
	}
}
