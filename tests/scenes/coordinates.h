// SPDX-License-Identifier: AGPL-3.0-or-later
/// Pictures whose colours are coordinates: what each pixel saw, to 1e-7 of the range.
#ifndef TESTS_COORDINATES_H
#define TESTS_COORDINATES_H

#include "povray.h"
#include "blackhole/vec.h"

#include <string>
#include <vector>

/// A scene's text as a function of the pigment that paints coordinates; it is rendered twice, coarse and fine.
/// In it, `Coordinates(R)` is a pigment that paints positions with |x|, |y|, |z| < R; on a sky_sphere R is 1.01.
struct Seen {
	int width, height;
	std::vector<blackhole::Vec3> values; ///< row by row
	std::vector<bool> black;             ///< nothing painted there
	std::string text;                    ///< what povray printed
	const blackhole::Vec3& at(int x, int y) const { return values[std::size_t(y * width + x)]; }
	bool is_black(int x, int y) const { return black[std::size_t(y * width + x)]; }
};

/// Renders and decodes; range is the R given to Coordinates. Fails the test if povray does.
Seen see(const std::string& scene, double range, int width, int height, const std::string& words = "");

/// A camera without surprises: `camera { ... }` text, and the direction of each of its pixels.
struct Camera {
	blackhole::Vec3 location, direction, right, up;
	/// A camera at a location that looks along direction, with pixels this many radians wide at the middle.
	Camera(blackhole::Vec3 location, blackhole::Vec3 direction, double radians, int width, int height);
	std::string text() const;
	blackhole::Vec3 pixel(int x, int y) const; ///< unit
	int width, height;
};

std::string text_of(const blackhole::Vec3& v);

/// v with its part along the radius at x multiplied by s: between coordinates and the static frame, written for the tests alone.
blackhole::Vec3 radial_times(const blackhole::Vec3& x, const blackhole::Vec3& v, double s);

#endif
