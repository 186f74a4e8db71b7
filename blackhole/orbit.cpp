// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/orbit.h"

#include <algorithm>
#include <limits>

namespace blackhole {
namespace {

using Quad = __float128;

template <typename T> struct Products {
	T r2, d2, s, h2; // |x|^2, |d|^2, x.d, |x cross d|^2
	Products(const Vec3& x, const Vec3& d) {
		const T a = x.x, b = x.y, c = x.z, e = d.x, f = d.y, g = d.z;
		const T i = b * g - c * f, j = c * e - a * g, k = a * f - b * e;
		r2 = a * a + b * b + c * c;
		d2 = e * e + f * f + g * g;
		s = a * e + b * f + c * g;
		h2 = i * i + j * j + k * k;
	}
};

// Newton from the double's root doubles its digits: two rounds are enough for quad.
Quad root(Quad a) {
	if (!(a > 0))
		return 0;
	Quad y = std::sqrt(static_cast<double>(a));
	for (int i = 0; i < 3; i++)
		y = (y + a / y) / 2;
	return y;
}
double root(double a) { return std::sqrt(a); }

// Beyond 3 Rs comparing b with its critical value is well conditioned: escape iff outward or b > b_c,
// with b^2 = h^2 / (d^2 - h^2 / r^3). Nearer, the square of the escape rule is compared, signs apart.
// Returns a number > 0 for escape; sets scale to the size of what was subtracted.
template <typename T> T margin(const Vec3& x, const Vec3& d, T& scale) {
	const Products<T> p(x, d);
	const T r = root(p.r2), r3 = p.r2 * r;
	if (r >= 3) {
		if (p.s >= 0) {
			scale = 0;
			return 1;
		}
		const T limit = T(27) / 4 * p.d2;
		const T have = p.h2 * (1 + T(27) / (4 * r3));
		// The cross product of nearly parallel vectors keeps an error of size |x|^2 |d|^2.
		scale = limit + p.r2 * p.d2 * std::min<T>(1, root(p.h2 / (p.r2 * p.d2)) + T(std::numeric_limits<double>::epsilon()));
		return have - limit;
	}
	const T left = p.s * (p.s < 0 ? -p.s : p.s) * (r3 + T(27) / 4);
	const T k = T(3) / 2 - r;
	const T right = k * (k < 0 ? -k : k) * (r + 3) * p.r2 * p.d2;
	scale = p.r2 * p.d2 * (r3 + T(27) / 4);
	return left - right;
}

} // namespace

Outcome classify(const Vec3& x, const Vec3& d) {
	// Lengths near the ends of the exponent's range would overflow when squared four times; quadruple precision's is wide enough.
	const double m = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
	const Vec3 u = (m > 1e30 || m < 1e-30) ? scaled(d) : d;
	double scale;
	const double quick = margin<double>(x, u, scale);
	if (std::fabs(quick) > 1e-13 * scale)
		return quick > 0 ? Outcome::escaped : Outcome::captured;
	Quad quad_scale;
	return margin<Quad>(x, d, quad_scale) > 0 ? Outcome::escaped : Outcome::captured;
}

Orbit::Orbit(const Vec3& x, const Vec3& d) {
	// In long double, and d as given: b keeps an error of 5e-20 r, where double would leave it 1e-16 r, most of a b far out.
	// Where even that is more than 5e-14 of b, in quadruple precision.
	using Long = long double;
	Long i = Long(x.y) * d.z - Long(x.z) * d.y, j = Long(x.z) * d.x - Long(x.x) * d.z, l = Long(x.x) * d.y - Long(x.y) * d.x;
	const Long size = std::sqrt(Long(d.x) * d.x + Long(d.y) * d.y + Long(d.z) * d.z);
	const Long distance = std::sqrt(Long(x.x) * x.x + Long(x.y) * x.y + Long(x.z) * x.z);
	Long twist = std::sqrt(i * i + j * j + l * l);
	if (twist < 1e-6L * distance * size) {
		i = Long(Quad(x.y) * d.z - Quad(x.z) * d.y);
		j = Long(Quad(x.z) * d.x - Quad(x.x) * d.z);
		l = Long(Quad(x.x) * d.y - Quad(x.y) * d.x);
		twist = std::sqrt(i * i + j * j + l * l);
	}
	r = double(distance);
	e1 = (1 / r) * x;
	const double radial = double((Long(x.x) * d.x + Long(x.y) * d.y + Long(x.z) * d.z) / (distance * size));
	double tangential = double(twist / (distance * size));
	if (tangential > 1e-300) {
		e2 = unit(cross({double(i / twist), double(j / twist), double(l / twist)}, e1));
	} else {
		// A radial ray stays on its line, in whatever plane.
		const Vec3 other = std::fabs(e1.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
		e2 = unit(other - dot(other, e1) * e1);
		tangential = 0;
	}
	const double hu = r * tangential;
	// The energy's square, 1 - hu^2 / r^3, without cancellation outside the horizon. On it a tangential ray has none: how little
	// is of no consequence, as the path over phi depends on radial / tangential alone.
	const double energy2 = radial * radial + tangential * tangential * ((r - 1) / r);
	const double speed = 1 / std::sqrt(std::max(energy2, 1e-30));
	p = {r, 0};
	v = {speed * radial, speed * tangential};
	h = speed * hu;
	k = std::min(h, 1.0);
	u = 1 / r;
	w = -v.x / std::max(h, 1.0);
}

} // namespace blackhole
