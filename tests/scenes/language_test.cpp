// SPDX-License-Identifier: AGPL-3.0-or-later
/// The statement: what may stand where, and one clear line for everything that may not.
#include "povray.h"

#include <gtest/gtest.h>

namespace {

const char* const camera = "camera { location <0, 0, -20> } sky_sphere { pigment { rgb 1 } }\n";

struct Bad {
	const char* scene;
	const char* says; ///< part of the message
	int line;         ///< of the file, 0 for none
};

// Broken over lines as POV-Ray's console breaks its messages.
std::string unbroken(std::string text) {
	std::string out;
	for (char c : text)
		if (!(c == '\n' || (c == ' ' && !out.empty() && out.back() == ' ')))
			out += c;
	return out;
}

// The name of the test: else a pointer's bytes, which change from run to run.
std::ostream& operator<<(std::ostream& out, const Bad& bad) { return out << bad.says; }

} // namespace

class Refused : public testing::TestWithParam<Bad> {};

TEST_P(Refused, WithOneClearLine) {
	const Bad& bad = GetParam();
	const Rendering run = povray(std::string(camera) + bad.scene, 8, 6);
	const std::string text = unbroken(run.text);
	EXPECT_NE(run.exit_code, 0);
	EXPECT_LT(run.exit_code, 128) << "crashed, or hung";
	EXPECT_TRUE(run.picture.samples.empty()) << "rendered as if all were well";
	EXPECT_NE(text.find(bad.says), std::string::npos) << bad.scene << "\nshould say: " << bad.says << "\nsaid:\n" << run.text;
	EXPECT_NE(text.find("File 'scene.pov' line " + std::to_string(bad.line)), std::string::npos) << run.text;
	EXPECT_NE(text.find("Error: "), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Language, Refused,
	testing::Values(Bad{"blackhole { 0, 1e-300 }", "radius must be between 1e-9 and 1e9; it is 1e-300", 3},
		Bad{"blackhole { 0, 1e300 }", "radius must be between 1e-9 and 1e9; it is 1e+300", 3},
		Bad{"blackhole { 0, -1 }", "radius must be between 1e-9 and 1e9; it is -1", 3},
		Bad{"blackhole { 0, 0 }", "radius must be between 1e-9 and 1e9; it is 0", 3},
		Bad{"#declare A = 1e300 * 1e300;\nblackhole { 0, A - A }", "radius must be between", 4},
		Bad{"#declare A = 1e300 * 1e300;\nblackhole { <A - A, 0, 0>, 1 }", "the centre must be a point", 4},
		Bad{"blackhole { 0, 1\n scale 1e12 }", "radius must be between 1e-9 and 1e9; it is 1e+12", 4},
		Bad{"blackhole { 0, 1\n effect_radius 1.5 }", "effect_radius must exceed 1.5 times the Schwarzschild radius", 4},
		Bad{"#declare A = 1e300 * 1e300;\nblackhole { 0, 1 effect_radius A - A }", "effect_radius must exceed", 4},
		Bad{"blackhole { 0, 1\n\n tolerance 0.2 }", "tolerance must be between 1e-9 and 0.1 radians; it is 0.2", 5},
		Bad{"blackhole { 0, 1 tolerance 1e-10 }", "tolerance must be between", 3},
		Bad{"blackhole { 0, 1 method \"euler\" }", "unknown method \"euler\"; known: \"rk4\", \"dopri5\", \"exact\"", 3},
		Bad{"blackhole { 0, 1 camera \"orbiting\" }",
			"unknown camera \"orbiting\"; known: \"static\", \"falling\", \"coordinate\"", 3},
		Bad{"blackhole { 0, 1\n scale <1, 2, 1> }", "only moves, rotations and uniform scales", 4},
		Bad{"blackhole { 0, 1 matrix <1, 0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0> }", "only moves, rotations and uniform scales", 3},
		Bad{"union { blackhole { 0, 1 } sphere { 9, 1 } scale <1, 2, 1> }", "only moves, rotations and uniform scales", 3},
		Bad{"blackhole { 0, 1 texture { pigment { rgb 1 } } }", "has no texture and no interior", 3},
		Bad{"blackhole { 0, 1 interior { ior 1.5 } }", "has no texture and no interior", 3},
		Bad{"blackhole { 0, 1 bounded_by { sphere { 0, 2 } } }", "cannot be bounded or clipped", 3},
		Bad{"blackhole { 0, 1 hollow }", "effect_radius, tolerance, method, camera", 3},
		Bad{"difference { sphere { 0, 3 } blackhole { 0, 1 } }", "cannot be part of a merge, intersection or difference", 3},
		Bad{"intersection { union { blackhole { 0, 1 } sphere { 0, 1 } } sphere { 0, 1 } }",
			"cannot be part of a merge, intersection or difference", 3},
		Bad{"merge { blackhole { 0, 1 } sphere { 0, 1 } }", "cannot be part of a merge, intersection or difference", 3},
		Bad{"union { blackhole { 0, 1 } sphere { <3, 0, 0>, 1 } inverse }", "cannot be part of an inverse union", 3},
		Bad{"sphere { 0, 1 bounded_by { blackhole { 0, 2 } } }", "cannot be part of a clip, a bound or a pattern", 3},
		Bad{"sphere { 0, 1 clipped_by { blackhole { 0, 2 } } }", "cannot be part of a clip, a bound or a pattern", 3},
		Bad{"light_source { 9, 1 looks_like { blackhole { 0, 1 } } }", "cannot be part of a looks_like", 3},
		Bad{"light_source { 9, 1 projected_through { blackhole { 0, 1 } } }", "cannot be part of a projected_through", 3},
		Bad{"blackhole { 0, 1 effect_radius 10 }\nblackhole { <15, 0, 0>, 1 effect_radius 10 }",
			"overlap; their largest radii that fit are 7.5 each", 4},
		Bad{"blackhole { 0, 1 effect_radius 5 camera \"falling\" }\nblackhole { <15, 0, 0>, 1 effect_radius 5 camera \"falling\" "
			"}",
			"Only one black hole can have camera \"falling\"", 4},
		Bad{"\nblackhole { <0, 0, -20>, 1 }", "the camera is at its centre", 4},
		Bad{"blackhole { <0, 0, -20>, 1 camera \"falling\" }", "the camera is at its centre", 3},
		Bad{"blackhole { <0, 0, -20.5>, 1 }", "at or inside the horizon, where no static observer can be; use camera \"falling\"",
			3},
		Bad{"blackhole { <0, 0, -21>, 1 camera \"coordinate\" }", "at or inside the horizon, where no coordinate observer can be",
			3},
		Bad{"union { blackhole { 0, 1 } sphere { 0, 3 } clipped_by { plane { y, 0 } } }", "cannot be part of what is clipped", 3},
		Bad{"camera { location <1e200, 0, 0> } blackhole { 0, 1 }", "the camera's location is not a point", 3},
		Bad{"blackhole { 0 }", "Expected", 3}, Bad{"blackhole { 0, 1", "End of File found instead", 3}));

namespace {

// The same picture, whichever way the hole is written.
void same(const std::string& a, const std::string& b) {
	const std::string rest = "sphere { <3, 1, 4>, 1.5 pigment { rgb x } finish { ambient 1 } } " + std::string(camera);
	const Rendering first = povray(rest + a, 24, 18), second = povray(rest + b, 24, 18);
	ASSERT_FALSE(first.picture.samples.empty()) << a << first.text;
	ASSERT_FALSE(second.picture.samples.empty()) << b << second.text;
	EXPECT_TRUE(first.picture == second.picture) << a << "\n" << b;
}

} // namespace

TEST(Language, OptionsStandInAnyOrder) {
	same("blackhole { <1, 0, 0>, 2 effect_radius 50 tolerance 1e-3 method \"rk4\" camera \"static\" bend_lights off }",
		"blackhole { <1, 0, 0>, 2 camera \"static\" bend_lights off tolerance 1e-3 method \"rk4\" effect_radius 50 }");
}

TEST(Language, DeclaredMovedAndScaled) {
	const std::string plain = "blackhole { <1, 0, 2>, 2 effect_radius 40 }";
	same(plain, "#declare Hole = blackhole { 0, 1 effect_radius 20 } object { Hole scale 2 translate <1, 0, 2> }");
	same(plain, "#declare Hole = blackhole { 0, 1 effect_radius 20 }; blackhole { Hole scale 2 translate <1, 0, 2> }");
	same(plain, "blackhole { 0, 1 translate <0.5, 0, 1> effect_radius 20 scale 2 }");
	same(plain, "union { blackhole { 0, 2 effect_radius 40 } sphere { <50, 0, 0>, 1 } translate <1, 0, 2> }");
	same(plain, "union { blackhole { 0, 2 effect_radius 40 } translate <1, 0, 2> }");
	same(plain, "#declare Two = union { union { blackhole { 0, 2 effect_radius 40 } } sphere { <50, 0, 0>, 1 } } object { Two "
				"translate <1, 0, 2> }");
	same("blackhole { <0, 0, 2>, 2 effect_radius 40 }",
		"blackhole { 0, 1 effect_radius 20 matrix <0, 2, 0, -2, 0, 0, 0, 0, 2, 0, 0, 2> }");
}

// A hole that is declared and not used does nothing; with Blackhole=off none does.
TEST(Language, OffGivesTheHoleFreeTwin) {
	const std::string scene = "sphere { <3, 1, 4>, 1.5 pigment { rgb x } } light_source { 9, 1 } " + std::string(camera);
	const Rendering none = povray(scene, 24, 18), off = povray(scene + "blackhole { 0, 1 }", 24, 18, "Blackhole=off"),
					on = povray(scene + "blackhole { 0, 1 }", 24, 18),
					declared = povray(scene + "#declare H = blackhole { 0, 1 }", 24, 18);
	EXPECT_TRUE(none.picture == off.picture);
	EXPECT_TRUE(none.picture == declared.picture);
	EXPECT_FALSE(none.picture == on.picture);
	EXPECT_FALSE(none.picture.samples.empty());
}

// All methods keep the tolerance, so their pictures are the same to within it.
TEST(Language, MethodsAgree) {
	const std::string scene =
		"sphere { <3, 1, 4>, 1.5 pigment { gradient y } finish { ambient 1 } } plane { y, -3 pigment { gradient x scale 20 } "
		"finish { ambient 1 } } " +
		std::string(camera);
	const Picture rk4 = povray(scene + "blackhole { 0, 1 tolerance 1e-5 }", 48, 36).picture;
	for (const char* method : {"dopri5", "exact"}) {
		const Rendering run = povray(scene + "blackhole { 0, 1 tolerance 1e-5 method \"" + method + "\" }", 48, 36);
		ASSERT_FALSE(run.picture.samples.empty()) << run.text;
		EXPECT_NE(joined(run.text).find(std::string("method ") + method), std::string::npos) << run.text;
		int other = 0;
		for (std::size_t i = 0; i < rk4.samples.size(); i++)
			other += std::abs(int(rk4.samples[i]) - int(run.picture.samples[i])) > 0.002 * 65535;
		EXPECT_LE(other, 20) << method; // of 5184: edges, and rays beside b_c
		EXPECT_FALSE(rk4 == run.picture) << method;
	}
}

TEST(Language, DeclareOnTheCommandLineSetsATolerance) {
	const Rendering run = povray(std::string(camera) + "blackhole { 0, 1 tolerance Tol }", 8, 6, "Declare=Tol=1e-2");
	EXPECT_NE(run.text.find("tolerance 0.01"), std::string::npos) << run.text;
}

TEST(Language, TheVersionIsPredeclared) {
	const Rendering run =
		povray(std::string(camera) +
				   "#ifdef (Blackhole_Version) #debug concat(\"version \", str(Blackhole_Version, 0, 1), \"\\n\") #end",
			8, 6);
	EXPECT_NE(run.text.find("version 1.0"), std::string::npos) << run.text;
}

// Far from each other two holes bend as each would alone.
TEST(Language, SeveralHoles) {
	const std::string scene =
		"camera { location <0, 0, -30> right 4/3*x direction 2*z } sky_sphere { pigment { checker rgb 0.2 rgb 1 scale 0.1 } } ";
	const Rendering both =
		povray(scene + "blackhole { <-6, 0, 0>, 0.5 effect_radius 5 } blackhole { <6, 0, 0>, 0.5 effect_radius 5 }", 64, 48);
	const Rendering left = povray(scene + "blackhole { <-6, 0, 0>, 0.5 effect_radius 5 }", 64, 48);
	ASSERT_FALSE(both.picture.samples.empty()) << both.text;
	int black_left = 0, black_right = 0;
	for (int y = 0; y < 48; y++)
		for (int x = 0; x < 64; x++)
			(x < 32 ? black_left : black_right) += both.picture.black(x, y);
	EXPECT_GT(black_left, 5);
	EXPECT_EQ(black_left, black_right); // the scene is its own mirror image, but for the sky
	for (int y = 0; y < 48; y++)
		for (int x = 0; x < 20; x++)
			ASSERT_EQ(both.picture.at(x, y, 0), left.picture.at(x, y, 0)) << x << " " << y;
}

// An orthographic camera has many origins; those inside a horizon are black, counted and named.
TEST(Language, OriginsInsideTheHorizonAreNamed) {
	const Rendering run = povray("camera { orthographic location <0, 0, -0.5> look_at 0 right 8*x up 6*y } sky_sphere { pigment "
								 "{ rgb 1 } } blackhole { <3, 0, -0.5>, 1 camera \"coordinate\" }",
		16, 12);
	EXPECT_EQ(run.exit_code, 0);
	EXPECT_NE(unbroken(run.text).find("started at or inside the horizon"), std::string::npos) << run.text;
}
