// SPDX-License-Identifier: AGPL-3.0-or-later
/// Between the directions an observer sees and the coordinate directions a path is traced in.
///
/// Each conversion of the program is here, once. Units as in orbit.h. R is the effect radius: g(R) = 1, so
/// nothing jumps when something crosses it; outside, the static frame and the coordinates are the same.
#ifndef BLACKHOLE_FRAMES_H
#define BLACKHOLE_FRAMES_H

#include "blackhole/vec.h"

namespace blackhole {

/// g(r) = sqrt(f(r) / f(R)) with f(r) = 1 - 1/r for 1 < r < R; 1 for r >= R; 0 at and inside the horizon.
double static_factor(double r, double R);

/// A direction seen by a static observer at x -> the coordinate direction (radial part times g), unit.
Vec3 static_to_coordinate(const Vec3& x, const Vec3& d, double R);
/// The inverse (radial part over g), unit. x must be outside the horizon.
Vec3 coordinate_to_static(const Vec3& x, const Vec3& d, double R);
/// A normal is a covector: its radial part times g goes from coordinates to the static frame. Keeps the
/// sign of its product with a direction that goes the same way; scaled to the normal's own length.
Vec3 normal_to_static(const Vec3& x, const Vec3& n, double R);

/// The direction in which an observer who fell from rest at infinity looks -> the coordinate direction, unit.
/// Returns false where the ray has no positive energy (only inside the horizon): nothing was ever sent along it.
/// Rain frame: Taylor & Wheeler, Exploring Black Holes, 2000, project B; beta = sqrt(1/r).
bool falling_to_coordinate(const Vec3& x, const Vec3& d, double R, Vec3& out);

} // namespace blackhole

#endif
