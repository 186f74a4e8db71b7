// SPDX-License-Identifier: AGPL-3.0-or-later
#include "coordinates.h"

#include <gtest/gtest.h>

#include <cmath>

using blackhole::Vec3;

namespace {

// Coarse: the value over the range; fine: 1024 times that, which POV-Ray's patterns wrap to [0, 1). Black stays free:
// both are painted between 0.1 and 0.9.
const char* macro(bool fine) { return fine ? "#declare Steps = 1024;" : "#declare Steps = 1;"; }

const char* pigment = R"(
#macro Coordinates(R) pigment { average pigment_map {
	[1 function { Steps * (0.5 + 0.5 * x / R) } color_map { [0 rgb <0.3, 0, 0>] [1 rgb <2.7, 0, 0>] }]
	[1 function { Steps * (0.5 + 0.5 * y / R) } color_map { [0 rgb <0, 0.3, 0>] [1 rgb <0, 2.7, 0>] }]
	[1 function { Steps * (0.5 + 0.5 * z / R) } color_map { [0 rgb <0, 0, 0.3>] [1 rgb <0, 0, 2.7>] }]
} } #end
)";

double decode(double coarse, double fine, double range) {
	const double c = (coarse - 0.1) / 0.8, f = (fine - 0.1) / 0.8;
	const double whole = std::round(c * 1024 - f);
	return ((whole + f) / 1024 * 2 - 1) * range;
}

} // namespace

Seen see(const std::string& scene, double range, int width, int height, const std::string& words) {
	const Rendering coarse = povray(macro(false) + std::string(pigment) + scene, width, height, words);
	const Rendering fine = povray(macro(true) + std::string(pigment) + scene, width, height, words);
	Seen seen{width, height, {}, {}, fine.text};
	if (coarse.picture.samples.empty() || fine.picture.samples.empty()) {
		ADD_FAILURE() << "no picture:\n" << coarse.text << fine.text;
		return seen;
	}
	for (int y = 0; y < height; y++)
		for (int x = 0; x < width; x++) {
			double v[3];
			for (int c = 0; c < 3; c++)
				v[c] = decode(coarse.picture.at(x, y, c), fine.picture.at(x, y, c), range);
			seen.values.push_back({v[0], v[1], v[2]});
			seen.black.push_back(coarse.picture.black(x, y));
		}
	return seen;
}

std::string text_of(const Vec3& v) { return "<" + number(v.x) + "," + number(v.y) + "," + number(v.z) + ">"; }

Vec3 radial_times(const Vec3& x, const Vec3& v, double s) {
	const Vec3 e = unit(x);
	return v + ((s - 1) * dot(v, e)) * e;
}

Camera::Camera(Vec3 l, Vec3 d, double radians, int w, int h) : location(l), direction(unit(d)), width(w), height(h) {
	const Vec3 across = unit(cross(std::fabs(direction.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, direction));
	right = (radians * w) * across;
	up = (radians * h) * cross(direction, across);
}

std::string Camera::text() const {
	return "camera { location " + text_of(location) + " direction " + text_of(direction) + " right " + text_of(right) + " up " +
		   text_of(up) + " }\n";
}

Vec3 Camera::pixel(int x, int y) const {
	return unit(direction + ((x + 0.5) / width - 0.5) * right + ((height - y - 0.5) / height - 0.5) * up);
}
