// SPDX-License-Identifier: AGPL-3.0-or-later
/// What the program says of a picture: the message at the start, the statistics, the ray paths. And that pictures
/// depend on neither the bounding method nor the number of threads.
#include "povray.h"
#include "blackhole/oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

using blackhole::Vec3;

namespace {

const std::string camera = "camera { location <0, 1, -15> look_at <0, 0, 0> } sky_sphere { pigment { gradient y color_map { [0 "
						   "rgb x] [1 rgb z] } scale 2 translate -y } }\n";
const std::string objects = "sphere { <3, 0, 3>, 1 pigment { rgb y } finish { reflection 0.5 ambient 1 } } sphere { <-3, 0, 2>, "
							"1 pigment { rgb 1 } finish { ambient 1 } } "
							"plane { y, -4 pigment { checker rgb 0 rgb 1 } finish { ambient 1 } }\n";

double value(const std::string& text, const std::string& label) {
	const std::size_t at = text.find(label);
	return at == std::string::npos ? -1 : std::strtod(text.c_str() + at + label.size(), nullptr);
}

} // namespace

TEST(Report, SaysWhatTheSceneRequires) {
	EXPECT_NE(joined(povray(camera + "blackhole { 0, 1 }", 16, 12).text).find("only the sky remains"), std::string::npos);
	const Rendering run = povray(camera + objects + "sphere { <0, 0, 500>, 1 } blackhole { 0, 1 effect_radius 20 }", 16, 12);
	EXPECT_NE(joined(run.text).find("3 of 4 objects within reach (1 plane, 2 sphere)"), std::string::npos) << run.text;
	const Rendering straddles = povray(camera + "sphere { <0, 1, 0>, 0.5 pigment { rgb 1 } } blackhole { 0, 1 }", 16, 12);
	EXPECT_NE(joined(straddles.text).find("1 object(s) reach into the horizon"), std::string::npos) << straddles.text;
	// A ring around the hole does not, though its bounding box does; and a light is no object to hit.
	const Rendering ring =
		povray(camera + "disc { <0, -0.5, 0>, y, 6, 3 pigment { rgb 1 } } light_source { 0.5, 1 } blackhole { 0, 1 }", 16, 12);
	EXPECT_EQ(ring.text.find("reach into"), std::string::npos) << ring.text;
	EXPECT_NE(joined(ring.text).find("1 of 1 objects within reach (1 disc)"), std::string::npos) << ring.text;
}

TEST(Report, Statistics) {
	const Rendering sky = povray(camera + "blackhole { 0, 1 }", 32, 24);
	EXPECT_EQ(value(sky.text, "Bent Rays:"), 32 * 24);
	int black = 0;
	for (int y = 0; y < 24; y++)
		for (int x = 0; x < 32; x++)
			black += sky.picture.black(x, y);
	EXPECT_EQ(value(sky.text, "Captured:"), black);
	EXPECT_GT(black, 0);
	EXPECT_EQ(value(sky.text, "Chords:"), 0) << "only the sky: no chords";
	EXPECT_EQ(value(sky.text, "Closed Form Alone:"), 32 * 24);
	EXPECT_EQ(value(sky.text, "Paths Followed:"), 0);
	EXPECT_EQ(value(sky.text, "Steps:"), 0);

	const Rendering full = povray(camera + objects + "blackhole { 0, 1 }", 32, 24);
	EXPECT_EQ(value(full.text, "Chords Tested:") + value(full.text, "Skipped:"), value(full.text, "Chords:"));
	EXPECT_GT(value(full.text, "Chords Tested:"), 0);
	EXPECT_NEAR(value(full.text, "Per Ray:"), value(full.text, "Chords:") / value(full.text, "Bent Rays:"), 0.006);
	EXPECT_GE(value(full.text, "Per Ray:"), 1);
	EXPECT_GT(value(full.text, "Most Turns:"), 0.4);
	EXPECT_EQ(value(full.text, "Charted Orbits:") + value(full.text, "Paths Followed:"), value(full.text, "Bent Rays:"));
	EXPECT_GT(value(full.text, "Charted Orbits:"), 9 * value(full.text, "Paths Followed:")) << "few orbits are not on the charts";
	EXPECT_EQ(value(full.text, "Closed Form Alone:"), 0);
	EXPECT_GE(value(full.text, "Object Tests:"), value(full.text, "Chords Tested:"));
	EXPECT_EQ(full.text.find("Through Media, Fog:"), std::string::npos);

	// A finer tolerance takes more steps, exact ones as many as ever, but that mirrors are met a hair elsewhere; fog takes all
	// rays' chords one by one.
	const auto with = [&](const char* words) { return povray(camera + objects + "blackhole { 0, 1 " + words, 32, 24).text; };
	const std::string fine = with("tolerance 1e-5 }");
	EXPECT_EQ(value(fine, "Charted Orbits:"), 0) << "too fine for charts";
	EXPECT_NEAR(value(fine, "Per Path:"), value(fine, "Steps:") / value(fine, "Paths Followed:"), 0.006);
	EXPECT_GT(value(with("tolerance 1e-7 }"), "Steps:"), 2 * value(fine, "Steps:"));
	const double exact = value(with("tolerance 1e-3 method \"exact\" }"), "Steps:");
	EXPECT_NEAR(value(with("tolerance 1e-6 method \"exact\" }"), "Steps:"), exact, 1e-3 * exact);
	const std::string fog = with("} fog { distance 100 rgb 0.5 }");
	EXPECT_EQ(value(fog, "Through Media, Fog:"), value(fog, "Charted Orbits:") + value(fog, "Paths Followed:"));

	EXPECT_EQ(povray(camera + objects, 16, 12).text.find("Bent Rays"), std::string::npos) << "no hole: not a word";
}

// Two shells of objects: what is tested in each adds up, and every hit is of a chord tested.
TEST(Report, StatisticsByShell) {
	const Rendering run = povray(camera + "sphere { <3, 0, 3>, 1 pigment { rgb 1 } } sphere { <-9, 0, 2>, 1 pigment { rgb 1 } } "
										  "blackhole { 0, 1 effect_radius 100 }",
		64, 48, "+BM2");
	std::vector<double> tested;
	for (std::size_t at = 0; (at = run.text.find("Tested at Radii:", at)) != std::string::npos; at++)
		tested.push_back(value(run.text.substr(at), "Tested at Radii:"));
	ASSERT_EQ(tested.size(), 2u) << run.text;
	EXPECT_GT(tested[0], 0);
	EXPECT_GT(tested[1], 0);
	EXPECT_EQ(tested[0] + tested[1], value(run.text, "Chords Tested:"));
	EXPECT_NEAR(value(run.text.substr(run.text.find("Tested at Radii:")), "From"), std::sqrt(18.0) - 1, 0.7) << "by its box";
	EXPECT_GT(value(run.text, "Hits:"), 0);
	EXPECT_LE(value(run.text, "Hits:"), value(run.text, "Chords Tested:"));

	// Of many shells the busiest, and the rest in one line.
	const std::string many = povray(camera + "#for (I, 0, 11) sphere { <3 + I, 0, 3 + I>, 0.2 pigment { rgb 1 } } #end "
											 "blackhole { 0, 1 effect_radius 100 }",
		64, 48)
								 .text;
	double sum = 0;
	int lines = 0;
	for (std::size_t at = 0; (at = many.find("Tested at Radii:", at)) != std::string::npos; at++, lines++)
		sum += value(many.substr(at), "Tested at Radii:");
	EXPECT_EQ(sum, value(many, "Chords Tested:"));
	EXPECT_LE(lines, 7) << many;
	EXPECT_NE(joined(many).find("shells more"), std::string::npos) << many;
}

// A surface whose normals are no numbers: its reflections are black, and that is said.
TEST(Report, RaysWithoutADirectionAreNamed) {
	const Rendering run =
		povray(camera + "plane { y, -4 pigment { rgb 1 } normal { function { sqrt(-1 - x*x) } 1 } finish { ambient "
						"0 reflection 1 } } blackhole { 0, 1 }",
			32, 24);
	const std::string text = joined(run.text);
	const std::size_t at = text.find("ray(s) had no direction that is a number; they are black");
	ASSERT_NE(at, std::string::npos) << run.text;
	int black = 0;
	for (int y = 0; y < 24; y++)
		for (int x = 0; x < 32; x++)
			black += run.picture.black(x, y);
	EXPECT_EQ(value(text, "Shutdown Warning:") + value(text, "Captured:"), black);
}

TEST(Report, NoCameraRayStartsInAHorizonUnnoticed) {
	const Rendering run = povray(camera + objects + "blackhole { 0, 1 }", 16, 12);
	EXPECT_EQ(run.text.find("started at or inside"), std::string::npos);
	EXPECT_EQ(run.text.find("could not be followed"), std::string::npos);
}

TEST(Pictures, DependOnNeitherBoundingNorThreads) {
	const std::string scene = camera + objects +
							  "union { #for (I, 0, 11) sphere { <5*cos(I), I/4 - 2, 5*sin(I)>, 0.4 pigment { rgb <1, I/12, 0> } "
							  "finish { ambient 0.5 reflection 0.2 } } #end } "
							  "light_source { <20, 30, -20> rgb 1 } blackhole { 0, 1 }";
	const Rendering first = povray(scene, 64, 48);
	ASSERT_FALSE(first.picture.samples.empty()) << first.text;
	for (const char* words : {"+BM0 -MB", "+BM2", "-MB", "+UV", "+WT4", "+WT8 +BM2"})
		EXPECT_TRUE(first.picture == povray(scene, 64, 48, words).picture) << words;
}

// The chords written are those traced: they join, they end where the row says, and lie on the exact path.
TEST(Ray_Paths, AreTheTracedChords) {
	const Rendering run =
		povray(camera + objects + "blackhole { 0, 1 tolerance 1e-4 }", 32, 24, "Ray_Paths=paths.csv Ray_Paths_Grid=8x6");
	std::ifstream in(run.folder + "/paths.csv");
	std::string line;
	ASSERT_TRUE(std::getline(in, line)) << run.text;
	EXPECT_EQ(line, "column,row,ray,level,chord,hole,x0,y0,z0,x1,y1,z1,tested,end,drift");
	std::map<std::string, int> ends;
	int rays = 0, rows = 0;
	Vec3 last{0, 0, 0}, origin{0, 0, 0}, start_direction{0, 0, 0};
	while (std::getline(in, line)) {
		std::vector<std::string> f;
		std::stringstream s(line);
		for (std::string cell; std::getline(s, cell, ',');)
			f.push_back(cell);
		f.resize(15);
		const Vec3 from{std::stod(f[6]), std::stod(f[7]), std::stod(f[8])},
			to{std::stod(f[9]), std::stod(f[10]), std::stod(f[11])};
		if (f[4] == "0") {
			rays++;
			origin = from;
			start_direction = to - from;
			if (f[3] == "1") {
				EXPECT_LT(length(from - Vec3{0, 1, -15}), 1e-12) << "camera rays start at the camera";
			}
		} else {
			EXPECT_LT(length(from - last), 1e-9) << line;
		}
		last = to;
		rows++;
		if (!f[13].empty()) {
			ends[f[13]]++;
			EXPECT_LT(std::stod(f[14]), 1e-4) << "drift";
			if (f[13] == "horizon") {
				EXPECT_NEAR(length(to), 1, 1e-9);
			}
		}
	}
	EXPECT_GE(rays, 48) << "one camera ray for each cell, and reflections";
	EXPECT_GT(ends["sky"], 0);
	EXPECT_GT(ends["object"], 0);
	EXPECT_GT(ends["horizon"], 0);

	const Rendering off =
		povray(camera + objects + "blackhole { 0, 1 }", 32, 24, "Ray_Paths=paths.csv Ray_Paths_Grid=8x6 Blackhole=off");
	std::ifstream twin(off.folder + "/paths.csv");
	int straight = 0;
	while (std::getline(twin, line))
		straight++;
	EXPECT_GT(straight, 48) << "the hole-free twin has paths too, straight ones";
	EXPECT_LT(straight, rows);
}

TEST(Ray_Paths, VrmlAndBadOptions) {
	const Rendering run = povray(camera + objects + "blackhole { 0, 1 }", 32, 24, "Ray_Paths=paths.wrl Ray_Paths_Grid=4x3");
	std::ifstream in(run.folder + "/paths.wrl");
	std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
	EXPECT_EQ(text.rfind("#VRML V2.0 utf8\n", 0), 0u) << run.text;
	int open = 0;
	for (char c : text)
		open += (c == '{' || c == '[') - (c == '}' || c == ']');
	EXPECT_EQ(open, 0);
	EXPECT_NE(text.find("IndexedLineSet"), std::string::npos);

	const struct {
		const char *words, *says;
	} bad[] = {{"Ray_Paths=paths.txt", "must end in .csv or .wrl"},
		{"Ray_Paths=p.csv Ray_Paths_Grid=0x4", "rays across x rays down"},
		{"Ray_Paths=p.csv Ray_Paths_Grid=many", "rays across x rays down"}};
	for (const auto& b : bad) {
		const Rendering r = povray(camera + "blackhole { 0, 1 }", 8, 6, b.words);
		EXPECT_NE(r.exit_code, 0) << b.words;
		EXPECT_NE(joined(r.text).find(b.says), std::string::npos) << b.words << "\n" << r.text;
	}
	const Rendering nowhere = povray(camera + "blackhole { 0, 1 }", 8, 6, "Ray_Paths=no/such/folder/p.csv");
	EXPECT_NE(nowhere.exit_code, 0) << "said before the picture is rendered, not after";
	EXPECT_NE(joined(nowhere.text).find("cannot write there"), std::string::npos) << nowhere.text;
}

TEST(Ray_Paths, DoNotChangeThePicture) {
	const Rendering with = povray(camera + objects + "blackhole { 0, 1 }", 32, 24, "Ray_Paths=p.csv"),
					without = povray(camera + objects + "blackhole { 0, 1 }", 32, 24);
	EXPECT_TRUE(with.picture == without.picture);
}

// Every sampling method has a first sample in each pixel.
TEST(Ray_Paths, AreKeptWithAntialiasing) {
	for (const char* method : {"+A0.1 +AM1", "+A0.1 +AM2"}) {
		const Rendering run =
			povray(camera + objects + "blackhole { 0, 1 }", 32, 24, std::string(method) + " Ray_Paths=p.csv Ray_Paths_Grid=4x3");
		std::ifstream in(run.folder + "/p.csv");
		std::string line;
		int first = 0;
		while (std::getline(in, line))
			first += line.find(",0,1,0,") != std::string::npos; // ray 0, level 1, chord 0
		EXPECT_EQ(first, 12) << method;
	}
}

// Nothing at r <= Rs is hit: a surface exactly there is not seen, not even as a speck.
TEST(Pictures, AnObjectAtTheHorizonIsNotSeen) {
	const Rendering run = povray(camera + "sphere { 0, 1 pigment { rgb y } finish { ambient 1 } } blackhole { 0, 1 }", 160, 120);
	ASSERT_FALSE(run.picture.samples.empty()) << run.text;
	for (int y = 0; y < 120; y++)
		for (int x = 0; x < 160; x++)
			ASSERT_EQ(run.picture.at(x, y, 1), 0) << x << " " << y;
}

// What fog does to a captured ray is one number over the whole disc: to within what its length differs.
TEST(Pictures, FogIsInFrontOfTheHorizonOnce) {
	const Rendering run = povray(
		"camera { location -15*z look_at 0 angle 50 } blackhole { 0, 1 tolerance 0.1 } fog { distance 30 rgb 0.5 }", 80, 60);
	ASSERT_FALSE(run.picture.samples.empty()) << run.text;
	EXPECT_NEAR(run.picture.at(40, 30, 0), 0.5 * (1 - std::exp(-14.0 / 30)), 0.003);
	EXPECT_NEAR(run.picture.at(43, 30, 0), run.picture.at(40, 30, 0), 0.005);
	const Rendering inside = povray(
		"camera { location -0.5*z look_at 0 angle 50 } blackhole { 0, 1 camera \"falling\" } fog { distance 30 rgb 0.5 }", 8, 6);
	EXPECT_TRUE(inside.picture.black(4, 3)) << "nothing was ever sent along that ray";
}
