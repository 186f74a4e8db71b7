// SPDX-License-Identifier: AGPL-3.0-or-later
/// What is known of a light ray around a Schwarzschild hole before it is traced.
///
/// Units and frame of the whole library: lengths in Schwarzschild radii (Rs = 1), positions relative to
/// the hole's centre in areal Schwarzschild coordinates laid on flat Cartesian axes, directions as
/// coordinate directions on those axes. Rays are traced backwards, from the eye.
///
/// A null geodesic is the Cartesian orbit x'' = -(3/2) h^2 x / r^5, h = |x cross x'| (from Binet's
/// u'' + u = (3/2) u^2; Misner, Thorne & Wheeler, Gravitation, 1973, section 25.6). Scaled to unit energy,
/// |v|^2 = 1 + h^2 / r^3 and h is the impact parameter b.
///
/// Paths are followed in the orbit's plane, in Binet's variables: u = 1/r over the angle phi swept since the start. So that
/// radial rays are no special case, the parameter is s = phi / k with k = min(b, 1): du/ds stays of the size of one for every b.
#ifndef BLACKHOLE_ORBIT_H
#define BLACKHOLE_ORBIT_H

#include "blackhole/vec.h"

namespace blackhole {

/// The impact parameter that parts captured from escaping rays, 3 sqrt(3) / 2 (MTW eq. 25.65).
constexpr double critical_b = 2.5980762113533159403;
/// Where light can circle the hole.
constexpr double photon_sphere = 1.5;

enum class Outcome { escaped, captured };

/// Whether a ray escapes to infinity, decided in closed form about the doubles as given: in double
/// precision where that is beyond doubt, in quadruple precision where it is close. With a the angle
/// off the outward radial it escapes iff cos a > (3/2 - r) sqrt((r + 3) / (r^3 + 27/4)); equality is capture.
/// x: position, |x| > 0; d: direction, any length > 0. Inside the horizon d must start outward with
/// positive energy (sin^2 a < r), as every ray of a falling observer that is not simply black does.
Outcome classify(const Vec3& x, const Vec3& d);

/// The plane a ray stays in and its start there, at unit energy.
struct Orbit {
	Vec3 e1;  ///< unit, outward radial at the start
	Vec3 e2;  ///< unit, the way the ray turns; h >= 0 by this choice
	double r; ///< radius of the start
	Vec2 p;   ///< start, (r, 0)
	Vec2 v;   ///< direction with |v|^2 = 1 + h^2 / r^3
	double h; ///< impact parameter b
	double k; ///< min(b, 1): phi = k s
	double u; ///< 1 / r
	double w; ///< du/ds at the start: dr/dlambda = -max(b, 1) du/ds

	/// x: position, |x| > 0; d: direction, any length > 0, of positive energy (always so outside the horizon).
	Orbit(const Vec3& x, const Vec3& d);

	Vec3 to_space(Vec2 q) const { return q.x * e1 + q.y * e2; }
	/// The point at u after the angle with this cosine and sine; and the velocity there (not of unit length).
	Vec3 point(double u, double cosine, double sine) const { return to_space({cosine / u, sine / u}); }
	Vec3 velocity(double u, double w, double cosine, double sine) const {
		const double out = -(h > 1 ? h : 1) * w, across = h * u;
		return to_space({out * cosine - across * sine, out * sine + across * cosine});
	}
};

} // namespace blackhole

#endif
