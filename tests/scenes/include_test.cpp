// SPDX-License-Identifier: AGPL-3.0-or-later
/// blackhole.inc: what cannot be is refused by name, and what is drawn is where and as large as it says.
#include "povray.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

const std::string include = "#include \"blackhole.inc\"\n";

struct Wrong {
	const char* call;
	const char* says;
};

std::ostream& operator<<(std::ostream& out, const Wrong& wrong) { return out << wrong.call; }

// As one line, however the console breaks it.
std::string unbroken(const std::string& text) {
	std::string out;
	for (char c : text)
		if (c != '\n' && (c != ' ' || out.empty() || out.back() != ' '))
			out += c;
	return out;
}

} // namespace

class Macro : public testing::TestWithParam<Wrong> {};

TEST_P(Macro, RefusesByNameAndValue) {
	const Wrong& wrong = GetParam();
	const Rendering run = povray(include + wrong.call + "\ncamera { location <0, 0, -9> }", 4, 3);
	EXPECT_NE(run.exit_code, 0);
	EXPECT_LT(run.exit_code, 128);
	EXPECT_TRUE(run.picture.samples.empty());
	EXPECT_NE(unbroken(run.text).find(wrong.says), std::string::npos) << run.text;
}

INSTANTIATE_TEST_SUITE_P(Include, Macro,
	testing::Values(Wrong{"object { Blackhole_Grid(0, 1, 0.9, 0.5, 12, 0.1) }",
						"Blackhole_Grid: R_Max must exceed the first circle's radius, 1.5000; it is 0.9000"},
		Wrong{"object { Blackhole_Grid(0, 1, 5, 0, 12, 0.1) }", "Blackhole_Grid: Step must exceed nothing, 0.0000; it is 0.0000"},
		Wrong{"object { Blackhole_Globe(0, 2, 1.5, 30, 0.1) }", "Blackhole_Globe: R must exceed Rs, 2.0000; it is 1.5000"},
		Wrong{"object { Blackhole_Disc(0, 1, 1, 5, <1, 1, 1>, <1, 0, 0>) }",
			"Blackhole_Disc: R_In must exceed Rs, 1.0000; it is 1.0000"},
		Wrong{"object { Blackhole_Disc(0, 1, 6, 5, <1, 1, 1>, <1, 0, 0>) }",
			"Blackhole_Disc: R_Out must exceed R_In, 6.0000; it is 5.0000"},
		Wrong{"object { Blackhole_Disc(0, -1, 6, 5, <1, 1, 1>, <1, 0, 0>) }",
			"Blackhole_Disc: Rs must exceed nothing, 0.0000; it is -1.0000"},
		Wrong{"sky_sphere { Blackhole_Stars(200, 1, 5, 1) }", "Blackhole_Pixel: Angle must be below 180; it is 200.0000"},
		Wrong{
			"sky_sphere { Blackhole_Stars(60, -1, 5, 1) }", "Blackhole_Stars: Pixels must exceed nothing, 0.0000; it is -1.0000"},
		Wrong{"sky_sphere { Blackhole_Stars(60, 2, 0, 1) }",
			"Blackhole_Stars: Per_Radian must exceed nothing, 0.0000; it is 0.0000"},
		Wrong{"sky_sphere { Blackhole_Stars(60, 50, 5, 1) }", "Blackhole_Stars: a star of 50.0000 pixels is too large"},
		Wrong{"#declare P = Blackhole_Fall(1, 3, 4, 0);", "Blackhole_Fall: R_Start must exceed R_End, 4.0000; it is 3.0000"},
		Wrong{"#declare P = Blackhole_Fall(1, 3, -1, 0);", "Blackhole_Fall: R_End cannot be less than nothing; it is -1.0000"},
		Wrong{"#declare P = Blackhole_Fall(1, 3, 1, 1.5);", "Blackhole_Fall: Clock must be from 0 to 1; it is 1.5000"},
		Wrong{"#declare P = Blackhole_Fall_Time(0, 3, 1);", "Blackhole_Fall_Time: Rs must exceed nothing, 0.0000; it is 0.0000"},
		Wrong{"#declare P = Blackhole_Orbit(1, 1.5, 0);", "Blackhole_Orbit: R must exceed 1.5 Rs, 1.5000; it is 1.5000"},
		Wrong{"#declare P = Blackhole_Orbit_Far(2, 2.5, 0);", "Blackhole_Orbit_Far: R must exceed 1.5 Rs, 3.0000; it is 2.5000"},
		Wrong{"#declare P = Blackhole_Orbit_Period(1, 1);", "Blackhole_Orbit_Period: R must exceed 1.5 Rs, 1.5000; it is 1.0000"},
		Wrong{"#declare P = Blackhole_Orbit_Period_Far(1, 1);",
			"Blackhole_Orbit_Period_Far: R must exceed 1.5 Rs, 1.5000; it is 1.0000"},
		Wrong{"#declare P = Blackhole_Photon_Circle(0, 1);",
			"Blackhole_Photon_Circle: Rs must exceed nothing, 0.0000; it is 0.0000"},
		Wrong{"#declare P = Blackhole_Orbit(-1, 3, 1);", "Blackhole_Orbit: Rs must exceed nothing, 0.0000; it is -1.0000"},
		Wrong{"#declare P = Blackhole_Photon_Period(-1);",
			"Blackhole_Photon_Period: Rs must exceed nothing, 0.0000; it is -1.0000"}));

namespace {

// Seen from straight above, far off, as a map: a pixel is 0.1 wide.
Picture from_above(const std::string& object) {
	const Rendering run =
		povray(include + "camera { orthographic location <0, 50, 0> direction -y up 16*z right 16*x } " + object, 160, 160);
	EXPECT_EQ(run.exit_code, 0) << run.text;
	EXPECT_FALSE(run.picture.samples.empty());
	return run.picture;
}

bool lit(const Picture& map, double x, double z) { return !map.black(int(80 + 10 * x), int(80 - 10 * z)); }

} // namespace

TEST(Include, GridLinesLieAtTheirRadii) {
	const Picture map =
		from_above("object { Blackhole_Grid(<1, 0, 0>, 1.1, 6, 1, 4, 0.3) pigment { rgb 1 } finish { ambient 1 diffuse 0 } }");
	for (const double angle : {0.5, 2.0, 4.0}) // between the spokes
		for (int i = 2; i < 14; i++) {
			const double r = i / 2.0;
			const bool line = i % 2 == 0 && r >= 2 && r <= 6;
			EXPECT_EQ(lit(map, 1 + r * std::cos(angle), r * std::sin(angle)), line) << "r " << r;
		}
	for (int spoke = 0; spoke < 4; spoke++)
		EXPECT_TRUE(lit(map, 1 + 4.5 * std::cos(spoke * std::acos(0)), 4.5 * std::sin(spoke * std::acos(0)))) << spoke;
}

TEST(Include, GlobeHasItsRadius) {
	const Picture map =
		from_above("object { Blackhole_Globe(<1, 0, 0>, 1, 5, 30, 0.3) pigment { rgb 1 } finish { ambient 1 diffuse 0 } }");
	for (const double angle : {0.2, 1.2, 3.3, 5.0}) {
		const auto at = [&](double r) { return lit(map, 1 + r * std::cos(angle), r * std::sin(angle)); };
		EXPECT_TRUE(at(5)) << "the equator";
		EXPECT_TRUE(at(2.5)) << "60 degrees";
		EXPECT_FALSE(at(5.4));
		EXPECT_FALSE(at(3.4));
	}
	for (int i = 0; i < 12; i++) { // along the meridians
		const double c = std::cos(i * std::acos(0) / 3), s = std::sin(i * std::acos(0) / 3);
		EXPECT_TRUE(lit(map, 1 + 3.4 * c, 3.4 * s)) << i;
		EXPECT_FALSE(lit(map, 1 + 5.35 * c, 5.35 * s)) << i;
	}
}

TEST(Include, DiscLiesBetweenItsRadii) {
	const Picture map = from_above("object { Blackhole_Disc(<1, 0, 0>, 1, 3, 6, <1, 0, 0>, <0, 0, 1>) }");
	double inner[3] = {}, outer[3] = {};
	for (int k = 0; k < 200; k++) {
		const double c = std::cos(k * 0.0314), s = std::sin(k * 0.0314);
		for (const double r : {0.5, 2.8, 6.2, 6.9})
			EXPECT_FALSE(lit(map, 1 + r * c, r * s)) << r;
		for (int channel = 0; channel < 3; channel++) {
			inner[channel] += map.at(int(90 + 35 * c), int(80 - 35 * s), channel);
			outer[channel] += map.at(int(90 + 54 * c), int(80 - 54 * s), channel);
		}
	}
	EXPECT_GT(inner[0], 3 * inner[2]) << "the inner colour at the inner rim";
	EXPECT_GT(outer[2], 3 * outer[0]) << "the outer at the outer";
	EXPECT_GT(inner[0], 20);
	EXPECT_GT(outer[2], 5);
}

// A star's size in pixels is what was asked for, at any picture's size: the spots' areas are counted.
TEST(Include, StarsHaveTheirSizeInPixels) {
	for (const int width : {160, 320})
		for (const int pixels : {6, 11}) {
			const Rendering run =
				povray(include + "camera { location <0, 0, -9> right 4/3*x up y angle 20 look_at 0 } sky_sphere { " +
						   "Blackhole_Stars(20, " + std::to_string(pixels) + ", " + number(1.6 * width / pixels) + ", 1) }",
					width, width * 3 / 4);
			ASSERT_EQ(run.exit_code, 0) << run.text;
			Picture p = run.picture;
			int stars = 0;
			double area = 0;
			for (int y = 0; y < p.height; y++)
				for (int x = 0; x < p.width; x++) {
					if (p.black(x, y))
						continue;
					// One spot: its pixels are taken out as they are counted.
					std::vector<std::pair<int, int>> todo{{x, y}};
					int count = 0;
					bool whole = true;
					while (!todo.empty()) {
						const auto [a, b] = todo.back();
						todo.pop_back();
						if (a < 0 || b < 0 || a >= p.width || b >= p.height) {
							whole = false;
							continue;
						}
						if (p.black(a, b))
							continue;
						for (std::size_t channel = 0; channel < 3; channel++)
							p.samples[std::size_t(b * p.width + a) * 3 + channel] = 0;
						count++;
						todo.insert(todo.end(), {{a - 1, b}, {a + 1, b}, {a, b - 1}, {a, b + 1}});
					}
					if (whole) {
						stars++;
						area += count;
						EXPECT_NEAR(std::sqrt(count / std::acos(-1)) * 2, pixels, 0.08 * pixels) << "a star at " << x << " " << y;
					}
				}
			ASSERT_GT(stars, 10);
			EXPECT_NEAR(2 * std::sqrt(area / stars / std::acos(-1)), pixels, 0.03 * pixels) << stars << " stars";
		}
}
