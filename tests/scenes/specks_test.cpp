// SPDX-License-Identifier: AGPL-3.0-or-later
/// No shape has specks: of a white body before black, no pixel inside is black, at whatever tolerance. Shapes that are found by
/// search, or whose code is blind for a start, are those that chords could miss where they join.
#include "povray.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>

namespace {

// Black pixels with four neighbours that are not; but not those that another tolerance shows black too: they are gaps.
int specks(const Picture& p, const Picture& other) {
	int n = 0;
	for (int y = 1; y < p.height - 1; y++)
		for (int x = 1; x < p.width - 1; x++) {
			n += p.black(x, y) && !other.black(x, y) && !p.black(x - 1, y) && !p.black(x + 1, y) && !p.black(x, y - 1) &&
				 !p.black(x, y + 1);
		}
	return n;
}

struct Shape {
	const char *name, *text;
};

std::ostream& operator<<(std::ostream& out, const Shape& s) { return out << s.name; }

class Specks : public testing::TestWithParam<Shape> {};

} // namespace

TEST_P(Specks, AreNowhere) {
	const std::string scene =
		"camera { location <0, 0, -6> look_at 0 angle 60 } #default { pigment { rgb 1 } finish { emission 1 ambient 0 "
		"diffuse 0 } }\n" +
		std::string(GetParam().text) + "\n";
	const auto with = [&](const char* tolerance) {
		return povray(scene + "blackhole { 0, 1 effect_radius 60 tolerance " + tolerance + " }", 160, 120).picture;
	};
	const Picture other = with("7e-5");
	for (const char* tolerance : {"1e-2", "5e-4", "1e-4", "1e-5"}) {
		const Picture picture = with(tolerance);
		ASSERT_FALSE(picture.samples.empty());
		int white = 0;
		for (int y = 0; y < 120; y++)
			for (int x = 0; x < 160; x++)
				white += !picture.black(x, y);
		const int n = specks(picture, other);
		std::printf("%s, tolerance %s: %d specks, %d pixels of it\n", GetParam().name, tolerance, n, white);
		EXPECT_GT(white, 500);
		EXPECT_EQ(n, 0) << tolerance;
	}
}

INSTANTIATE_TEST_SUITE_P(Of, Specks,
	testing::Values(
		Shape{"isosurface",
			"#include \"functions.inc\"\nisosurface { function { f_sphere(x, y, z, 2.2) - 0.2*sin(5*x)*sin(5*y) } max_gradient 2 "
			"contained_by { sphere { 0, 3 } } }"},
		Shape{"isosurface, coarse", "#include \"functions.inc\"\nisosurface { function { f_sphere(x, y, z, 2.2) } accuracy 0.01 "
									"max_gradient 2 contained_by { "
									"sphere { 0, 3 } } }"},
		Shape{"isosurface, scaled",
			"isosurface { function { x*x + y*y + z*z - 1 } max_gradient 3 contained_by { sphere { 0, 1.4 } } "
			"scale 2.2 }"},
		Shape{"sphere_sweep",
			"sphere_sweep { b_spline 6, <-4, -2, 0>, 0.6, <-2.5, 2, 0>, 0.6, <-1, 2.5, 1>, 0.6, <1, 2.5, 1>, 0.6, "
			"<2.5, 2, 0>, 0.6, <4, -2, 0>, 0.6 tolerance 1e-2 }"},
		Shape{"blob", "blob { threshold 0.6 sphere { <-0.7, 0, 0>, 1.9, 1 } sphere { <0.9, 0.3, 0>, 1.9, 1 } scale 1.6 }"},
		Shape{"blob, scaled",
			"blob { threshold 0.6 sphere { <-0.07, 0, 0>, 0.19, 1 } sphere { <0.09, 0.03, 0>, 0.19, 1 } scale 16 }"},
		Shape{"lathe", "lathe { cubic_spline 6, <0, -3>, <0.1, -2.2>, <2, -1>, <2, 1>, <0.1, 2.2>, <0, 3> }"},
		Shape{"surface of revolution", "sor { 6, <0.5, -3>, <1, -2.2>, <2, -1>, <2, 1>, <1, 2.2>, <0.5, 3> }"},
		Shape{"torus", "torus { 2.2, 0.6 rotate 60*x }"}, Shape{"superellipsoid", "superellipsoid { <0.4, 0.7> scale 2 }"},
		Shape{"julia_fractal", "julia_fractal { <-0.08, 0, -0.83, -0.02> quaternion max_iteration 5 precision 30 scale 2 }"},
		Shape{"prism", "prism { linear_spline -2, 2, 6, <0, 2>, <2, 0.5>, <1, -2>, <-1, -2>, <-2, 0.5>, <0, 2> }"},
		Shape{"height_field",
			"height_field { function 30, 30 { 0.5 + 0.4*sin(9*x)*sin(7*y) } smooth translate <-0.5, 0, -0.5> scale "
			"<9, 2, 9> translate -2*y }"},
		Shape{
			"difference", "difference { box { -2, 2 } sphere { <0, 0, -2.5>, 1.8 } cylinder { <-3, 1, 0>, <3, 1, 0>, 0.4 } }"}));
