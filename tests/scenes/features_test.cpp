// SPDX-License-Identifier: AGPL-3.0-or-later
/// Every feature of POV-Ray around a hole: the scenes of features/ are asked the same questions, each of which a mistake in
/// handing chords to POV-Ray, or in what is done along them, would answer wrongly. The hole-free twin says what POV-Ray
/// itself does with the same question.
#include "povray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

std::vector<std::string> names() {
	std::vector<std::string> list;
	for (const auto& file : std::filesystem::directory_iterator(FEATURES))
		if (file.path().extension() == ".pov")
			list.push_back(file.path().stem());
	std::sort(list.begin(), list.end());
	return list;
}

class Feature : public testing::TestWithParam<std::string> {
protected:
	// The feature's picture; twin: without the hole.
	Picture render(bool twin, const std::string& words = "", const std::string& more = "") {
		const Rendering run = povray("#include \"" + GetParam() + ".pov\"\n" + more, 64, 48,
			std::string("+L" FEATURES " ") + words + (twin ? " Blackhole=off" : ""));
		EXPECT_FALSE(run.picture.samples.empty()) << run.text;
		EXPECT_EQ(run.text.find("could not be followed"), std::string::npos);
		text = run.text;
		return run.picture;
	}
	// A limit the scene's file states for itself, with the reason beside it: "// <word> limit 0.02: because".
	double limit(const std::string& word, double otherwise) {
		std::ifstream in(std::string(FEATURES "/") + GetParam() + ".pov");
		for (std::string line; std::getline(in, line);)
			if (line.rfind("// " + word + " limit ", 0) == 0)
				return std::stod(line.substr(10 + word.size()));
		return otherwise;
	}
	std::string text;
};

// The share of pixels with a channel that differs by more than this.
double differing(const Picture& a, const Picture& b, double by) {
	if (a.samples.size() != b.samples.size() || a.samples.empty())
		return 1;
	int n = 0;
	for (std::size_t i = 0; i < a.samples.size(); i += 3) {
		int most = 0;
		for (std::size_t c = i; c < i + 3; c++)
			most = std::max(most, std::abs(int(a.samples[c]) - int(b.samples[c])));
		n += most > by * 65535;
	}
	return n * 3.0 / double(a.samples.size());
}

double value(const std::string& text, const std::string& label) {
	const std::size_t at = text.find(label);
	return at == std::string::npos ? -1 : std::strtod(text.c_str() + at + label.size(), nullptr);
}

} // namespace

// The scene is about the hole at all: much of the picture is other than without it, and some of it is black.
TEST_P(Feature, IsBent) {
	const Picture hole = render(false), twin = render(true);
	EXPECT_GT(differing(hole, twin, 0.02), 0.1);
}

// A hole of next to no mass, followed in many chords, changes nothing: what is added up along chords is what a straight ray
// gives. Light is bent by 1e-5 radians at most, a pixel is 1e-2.
TEST_P(Feature, TendsToTheHoleFreePicture) {
	const Picture hole = render(false, "Declare=Rs=1e-5 Declare=Tol=1e-9");
	const double chords = value(text, "Per Ray:");
	const Picture twin = render(true);
	const double share = differing(hole, twin, 0.004);
	std::printf("%s: %.1f chords a ray, %.2f %% of pixels differ by over 0.4 %%\n", GetParam().c_str(), chords, 100 * share);
	EXPECT_GT(chords, 5);
	EXPECT_LE(share, limit("Straight", 0.002));
}

// A hole that no ray comes near changes not one bit: straight legs are POV-Ray's own.
TEST_P(Feature, IsTheHoleFreePictureFarFromTheHole) {
	const Picture far = render(false, "Declare=Far=1");
	EXPECT_GE(value(text, "Bent Rays:"), 0) << "there is no hole";
	EXPECT_LE(value(text, "Bent Rays:"), 20) << "the hole is not far"; // a mirror may send one that way
	EXPECT_LE(differing(far, render(true, "Declare=Far=1"), 0), limit("Far", 0));
}

// The same pixels whichever way objects are bounded and however many threads work, where POV-Ray's own are: its radiosity and
// some of its random numbers depend on which thread gets which block.
TEST_P(Feature, DependsOnNeitherBoundingNorThreads) {
	const Picture hole = render(false);
	for (const char* words : {"-MB", "+BM2", "-UV", "-UL"})
		EXPECT_TRUE(hole == render(false, words)) << words;
	EXPECT_LE(differing(hole, render(false, "+WT4"), 0), limit("Threads", 0));
}

// What rays may hit is found in the plane of their orbit where objects are few, in a tree where they are many: of either no pixel
// depends, and objects that no ray can hit make them many.
TEST_P(Feature, IsTheSameWithManyObjects) {
	const std::string unseen =
		"#local N = 0; #while (N < 200) sphere { vrotate((3 + N / 10) * x, <0, 37 * N, 23 * N>), 1e-6 no_image "
		"no_reflection no_shadow photons { pass_through } Put() } #local N = N + 1; #end";
	const Picture few = render(false);
	const std::string found = text;
	const Picture many = render(false, "", unseen);
	EXPECT_GT(value(text, "method rk4;"), value(found, "method rk4;") + 150) << text;
	EXPECT_LE(differing(few, many, 0), limit("Many", 0));
}

// Turned and mirrored as a whole, the picture stays what it was, but for pixels on edges.
TEST_P(Feature, IsTheSameTurnedAndMirrored) {
	const Picture hole = render(false), twin = render(true);
	if (limit("Turned", 0.01) >= 1)
		GTEST_SKIP() << "POV-Ray's own is not";
	for (const char* words : {"Declare=Turned=1", "Declare=Mirrored=1"}) {
		const double bent = differing(hole, render(false, words), 0.01), straight = differing(twin, render(true, words), 0.01);
		std::printf(
			"%s %s: %.2f %% of pixels differ, without the hole %.2f %%\n", GetParam().c_str(), words, 100 * bent, 100 * straight);
		EXPECT_LE(bent, straight * 1.3 + limit("Turned", 0.01)) << words;
	}
}

// At other scales the picture changes no more than POV-Ray's own does.
TEST_P(Feature, IsTheSameAtEveryScale) {
	const Picture hole = render(false), twin = render(true);
	if (limit("Scale", 0.01) >= 1)
		GTEST_SKIP() << "POV-Ray's own is not";
	for (const char* words : {"Declare=Size=1e-2", "Declare=Size=1e4"}) {
		const double bent = differing(hole, render(false, words), 0.01), straight = differing(twin, render(true, words), 0.01);
		std::printf(
			"%s %s: %.2f %% of pixels differ, without the hole %.2f %%\n", GetParam().c_str(), words, 100 * bent, 100 * straight);
		EXPECT_LE(bent, straight * 1.3 + limit("Scale", 0.01)) << words;
	}
}

// The ways to sample a pixel add up bent rays as they do straight ones.
TEST(Antialiasing, TendsToTheHoleFreePicture) {
	for (const char* scene : {"csg", "textures", "fog"})
		for (const char* words : {"+A0.1 +AM1 -J", "+A0.1 +AM2 -J", "+A0.02 +AM2 +R4 +J", "+A0.3 +AM1 +R5 +J"}) {
			const std::string all = std::string("+L" FEATURES " ") + words, text = std::string("#include \"") + scene + ".pov\"";
			const Picture hole = povray(text, 64, 48, all + " Declare=Rs=1e-5 Declare=Tol=1e-9").picture,
						  twin = povray(text, 64, 48, all + " Blackhole=off").picture,
						  without = povray(text, 64, 48, std::string("+L" FEATURES " Blackhole=off")).picture;
			EXPECT_LE(differing(hole, twin, 0.004), 0.005) << scene << " " << words;
			EXPECT_GT(differing(twin, without, 0.01), 0.02) << "no pixel of " << scene << " wants " << words;
		}
}

// A scene that is its own mirror image gives a picture that is.
TEST(Symmetry, OfTheSceneIsThatOfThePicture) {
	const std::string half = "sphere { <3, 1, 4>, 1.2 pigment { rgb <1, 0.4, 0.2> } finish { reflection 0.3 } } "
							 "box { <1, -2, -3>, <2.2, -1, -2> pigment { rgbt <0.4, 1, 0.5, 0.5> } interior { ior 1.3 } } ";
	for (int width : {64, 65}) {
		const Rendering run = povray("camera { location <0, 2, -14> right x*image_width/image_height look_at 0 angle 45 } "
									 "light_source { <0, 20, -10> rgb 1 } "
									 "sky_sphere { pigment { gradient y color_map { [0 rgb 0.1] [1 rgb <0.2, 0.4, 1>] } } } "
									 "plane { y, -3 pigment { rgb 0.6 } } "
									 "fog { distance 50 color rgb 0.7 } " +
										 half + "union { " + half + " scale <-1, 1, 1> } blackhole { 0, 1 bend_lights off }",
			width, 48);
		ASSERT_FALSE(run.picture.samples.empty()) << run.text;
		int other = 0;
		for (int y = 0; y < 48; y++)
			for (int x = 0; x < width; x++)
				for (int c = 0; c < 3; c++)
					other += std::fabs(run.picture.at(x, y, c) - run.picture.at(width - 1 - x, y, c)) > 1e-4;
		EXPECT_LE(other, 6) << width; // the two rays nearest a silhouette differ by rounding
	}
}

// A bent ray is one level, however many chords it has.
TEST(Levels, AreCountedByRays) {
	const std::string view =
		"camera { location <0, 0, -14> look_at 0 angle 45 } sky_sphere { pigment { rgb 1 } } blackhole { 0, 1 tolerance 1e-6 } ";
	EXPECT_NE(povray(view + "sphere { <0, 0, 5>, 2 pigment { rgb 1 } }", 32, 24).text.find("Max Level: 1/5"), std::string::npos);
	EXPECT_NE(povray(view + "sphere { <0, 0, 500>, 200 pigment { rgb 1 } finish { reflection 1 } }", 32, 24)
				  .text.find("Max Level: 2/5"),
		std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, Feature, testing::ValuesIn(names()), [](const auto& info) { return info.param; });
