// SPDX-License-Identifier: AGPL-3.0-or-later
#include "trade.h"

namespace trade {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// The camera r from the hole, so many degrees above the plane y = 0, with POV-Ray's angle (the picture's whole width), turned
// aside from the hole by so many degrees.
Scene scene(const char* name, const char* what, double r, double above, double angle, double aside = 0) {
	Scene s{};
	s.name = name;
	s.what = what;
	s.eye = r * Vec3{0, std::sin(above * degree), -std::cos(above * degree)};
	const Vec3 hole = -unit(s.eye), right{1, 0, 0};
	s.up = cross(hole, right);
	s.ahead = std::cos(aside * degree) * hole + std::sin(aside * degree) * right;
	s.right = cross(s.up, s.ahead);
	s.pixel = std::tan(angle / 2 * degree) / (width / 2);
	return s;
}

Scene with(Scene s, const Plane& plane) {
	s.has_plane = true;
	s.plane = plane;
	return s;
}

} // namespace

std::vector<Scene> scenes() {
	const Plane disc{{0, 0, 0}, {0, 1, 0}, 3, 10, false}, wall{{0, 0, 10}, {0, 0, 1}, 0, 1e9, false};
	const Plane floor{{0, -3, 0}, {0, 1, 0}, 0, 1e9, false};
	const Scene glass = scene("mirror", "looking-glass of 10 Rs beside the hole from 12 Rs, angle 67", 12, 7, 67, 12);
	const Vec3 beside{7, 0, 5}, behind{0, 0, 6};
	// The hole is seen in the middle of the one; the other throws light by the hole a second time.
	const Plane mirror{beside, unit(unit(glass.eye - beside) + unit(-beside)), 0, 5, true};
	const Plane back{behind, {std::sin(15 * degree), 0, std::cos(15 * degree)}, 0, 1e9, true};
	return {
		scene("far", "sky from 100 Rs, angle 12", 100, 7, 12),
		scene("middle", "sky from 25 Rs, angle 40", 25, 7, 40),
		scene("near", "sky from 10 Rs, angle 67", 10, 7, 67),
		with(scene("disc", "disc of 3 to 10 Rs from 25 Rs, angle 55", 25, 10, 55), disc),
		with(scene("wall", "wall 10 Rs behind the hole from 10 Rs, angle 67", 10, 7, 67), wall),
		with(scene("floor", "floor 3 Rs below the hole from 10 Rs, angle 67", 10, 7, 67), floor),
		with(scene("close", "disc of 3 to 10 Rs from 2 Rs, past the hole, angle 90", 2, 30, 90, 60), disc),
		with(glass, mirror),
		with(scene("twice", "mirror 6 Rs behind the hole from 12 Rs, angle 60", 12, 7, 60), back),
	};
}

} // namespace trade
