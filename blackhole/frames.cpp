// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/frames.h"

namespace blackhole {
namespace {

// v with its part along the radial direction of x multiplied by s.
Vec3 scale_radial(const Vec3& x, const Vec3& v, double s) {
	const Vec3 e = unit(x);
	return v + ((s - 1) * dot(v, e)) * e;
}

} // namespace

double static_factor(double r, double R) {
	if (r >= R)
		return 1;
	if (r <= 1)
		return 0;
	return std::sqrt((r - 1) * R / (r * (R - 1)));
}

Vec3 static_to_coordinate(const Vec3& x, const Vec3& d, double R) {
	const double g = static_factor(length(x), R);
	return g == 1 ? d : unit(scale_radial(x, d, g));
}

Vec3 coordinate_to_static(const Vec3& x, const Vec3& d, double R) {
	const double g = static_factor(length(x), R);
	return g == 1 ? d : unit(scale_radial(x, d, 1 / g));
}

Vec3 normal_to_static(const Vec3& x, const Vec3& n, double R) {
	const double g = static_factor(length(x), R);
	return g == 1 ? n : length(n) * unit(scale_radial(x, n, g));
}

bool falling_to_coordinate(const Vec3& x, const Vec3& d, double R, Vec3& out) {
	const double r = length(x), beta = std::sqrt(1 / r);
	const Vec3 e = unit(x), n = unit(d);
	const double radial = dot(n, e);
	if (r <= 1 && 1 + beta * radial <= 0)
		return false;
	const Vec3 across = n - radial * e;
	if (r < R)
		out = unit(((radial + beta) / std::sqrt(1 - 1 / R)) * e + across);
	else
		out = unit((radial + beta) * e + std::sqrt(1 - 1 / r) * across);
	return true;
}

} // namespace blackhole
