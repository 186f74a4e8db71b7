// SPDX-License-Identifier: AGPL-3.0-or-later
/// Exact null geodesics by quadrature, in long double: the witness the library is tested against.
///
/// Shares no equation of motion with the library: it never integrates an orbit in time, but evaluates
/// phi = integral du / sqrt(1/b^2 - u^2 + u^3) (Chandrasekhar, The Mathematical Theory of Black Holes, 1983,
/// chapter 3, eq. 215 ff.), with the root of the cubic at a turning point factored out. Units as blackhole/orbit.h.
#ifndef TESTS_ORACLE_H
#define TESTS_ORACLE_H

#include "blackhole/vec.h"

#include <functional>
#include <vector>

namespace oracle {

using Real = long double;

/// A ray from radius r0 whose coordinate direction is at angle a off the outward radial.
class Ray {
public:
	Ray(Real r0, Real a);

	bool escapes() const { return escapes_; }
	Real b() const { return b_; }
	bool turns() const { return turns_; }
	/// Radius of the turning point, and the angle swept up to it, if turns().
	Real turning_radius() const { return 1 / up_; }
	Real turning_angle() const { return turning_angle_; }

	/// Angle swept when the radius r is reached: the first time (leg 0) or after the turning point (leg 1).
	Real swept(Real r, int leg) const;
	/// Angle off the outward radial, in coordinates, at r on the leg.
	Real angle(Real r, int leg) const;
	/// Distance of the point at radius r and swept angle phi from the path, to first order.
	Real distance(Real r, Real phi) const;

private:
	Real integral(Real from, Real to) const; // over u
	Real r0_, b_, up_ = 0, turning_angle_ = 0;
	Real u3_ = 0, u1_ = 0; // the cubic's other roots
	bool escapes_, turns_ = false, outward_;
	bool barrier_ = false; // whether b > b_c, so that the cubic has up_ to factor out
};

/// What a ray in space sees when it leaves the sphere of radius R: false if it is captured.
bool exit_direction(const blackhole::Vec3& x, const blackhole::Vec3& d, double R, blackhole::Vec3& direction,
	blackhole::Vec3& position, double* b = nullptr);

/// The position on the ray at radius r on the leg (see swept), for objects centred on the hole.
blackhole::Vec3 point(const blackhole::Vec3& x, const blackhole::Vec3& d, double r, int leg);

/// Follows the exact path until f changes its sign (from its value a little after the start), up to radius R or the
/// horizon. Returns false if it never does; otherwise the point and the path's unit tangent there.
bool first_hit(const blackhole::Vec3& x, const blackhole::Vec3& d, double R,
	const std::function<double(const blackhole::Vec3&)>& f, blackhole::Vec3& point, blackhole::Vec3& tangent);

/// Points on the exact path from x on, to the radius R on its way out or to the horizon; n for each leg. Their polyline's
/// length falls short by a share of 1 / n^2.
std::vector<blackhole::Vec3> polyline(const blackhole::Vec3& x, const blackhole::Vec3& d, double R, int n);

/// Distance of a point q from the exact path through x along d, to first order; q must be near the path.
/// turns: how often q has been round the hole already (its angle is taken in [2 pi turns, 2 pi turns + 2 pi)).
double distance(const blackhole::Vec3& x, const blackhole::Vec3& d, const blackhole::Vec3& q, int turns = 0);

} // namespace oracle

#endif
