// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/closed.h"

#include <algorithm>

namespace blackhole {
namespace {

using Quad = __float128;

double root(double a) { return std::sqrt(a); }
long double root(long double a) { return std::sqrt(a); }
Quad root(Quad a) {
	Quad y = std::sqrt(static_cast<double>(a));
	for (int i = 0; i < 2; i++)
		y = (y + a / y) / 2;
	return y;
}

// F2, B and kappa. With w = u - 2/3, 4/27 - u^2 + u^3 = w^2 (u + 1/3), so kappa needs neither b nor its critical value.
// Returns whether T had the digits: by the size of what kappa's rounding errors are, over kappa.
template <typename T> inline bool measure(const Vec3& x, const Vec3& d, Launch& l) {
	const T a = x.x, b = x.y, c = x.z, e = d.x, f = d.y, g = d.z;
	const T i = b * g - c * f, j = c * e - a * g, k = a * f - b * e;
	const T r2 = a * a + b * b + c * c, s = a * e + b * f + c * g, n2 = i * i + j * j + k * k;
	l.axis = {double(i), double(j), double(k)};
	l.outward = s >= 0;
	const T r = root(r2), u = 1 / r;
	l.r = double(r);
	l.u = double(u);
	const T s2 = s * s;
	l.radial = n2 <= T(1e-60) * s2;
	if (l.radial) {
		l.F2 = l.B = l.across = 0;
		l.kappa = -1;
		return sizeof(T) > sizeof(double);
	}
	const T across = 1 / root(r2 * n2);
	const T F2 = s2 * across * across, w = u - T(2) / 3, Q2 = w * w * (u + T(1) / 3);
	const T kappa = T(6.75) * (Q2 - F2);
	l.across = double(across);
	l.F2 = double(F2);
	l.B = std::max(1e-300, double(F2 + u * u * (1 - u))); // <= 0 if d had no energy: no ray at all, but no NaN either
	l.kappa = double(kappa);
	const T error = F2 * (u * u + F2 * (1 + F2 * r2)) + w * w * (1 + u * u * u * u);
	constexpr double digits = sizeof(T) == sizeof(double) ? 400 : 8e5;
	return error < T(digits * digits) * kappa * kappa;
}

// A root of m^2 (1 + m) = B, with s = sqrt(B); Halley's method, from a fit of m/s good to 7e-6.
inline double negative_root(double B, double s) {
	double m;
	int rounds = 1;
	if (s < 0.77) {
		const double s2 = s * s;
		const double p0 = 0.9999929637619972 - 0.49909040458556325 * s, p2 = 0.6045712939328531 - 0.8140005965921753 * s;
		const double p4 = 0.8913262577235064 - 0.6148118510285162 * s;
		m = s * (p0 + s2 * (p2 + s2 * (p4 + s2 * 0.18868471603158574)));
	} else {
		const double c = std::cbrt(B);
		m = c - 1.0 / 3 + 1 / (9 * c);
		rounds = 3;
	}
	for (int i = 0; i < rounds; i++) {
		const double g = m * m * (1 + m) - B, g1 = m * (3 * m + 2), g2 = 3 * m + 1;
		m -= g * g1 / (g1 * g1 - g * g2);
	}
	return m;
}

// f at y for a ray that starts at x: of the forms of f, the one without cancellation.
inline double value(const Cubic& c, double x, double F2, double y) {
	if (c.kappa > 0 && x < 2.0 / 3)
		return std::max(0.0, F2 + (x - y) * (x + y - (x * x + x * y + y * y)));
	const double w = y - 2.0 / 3;
	if (y < 1.0 / 3 || y > 1)
		return c.B - y * y * (1 - y);
	return std::max(0.0, w * w * (y + 1.0 / 3) - 4.0 / 27 * c.kappa);
}

// Carlson's integral of the first kind, from its arguments X1 (at the root -m), and the sum T and product N of the other
// two, real or conjugate. Duplication (DLMF 19.26.18) with the pair kept as T and N, unscaled, so that with w the mean of
// the arguments E2 w^2 and E3 w^3 stay those of the cubic (about its inflexion at 1/3): -1/3 and 2/27 - B.
// The series is DLMF 19.19.7 with a = 1/2, c = 3/2, to the eleventh order; what is left out, 6e-6 / w^12, decides how
// far to go.
inline double carlson(double X1, double T, double N, double factor, double B) {
	const double beta = 2.0 / 27 - B, limit = std::fabs(beta) * (27 * 1500);
	double w3 = X1 + T;
	while (w3 < 18 || w3 * w3 * w3 < limit) {
		const double n = std::sqrt(N), lambda = n + std::sqrt(X1 * (T + 2 * n));
		N += lambda * (T + lambda);
		T += 2 * lambda;
		X1 += lambda;
		w3 = X1 + T;
		factor *= 2;
	}
	const double t = 3 / w3, t2 = t * t, a = -1.0 / 3 * t2, e = beta * (t * t2), a2 = a * a;
	const double c0 = (1 - a * (1.0 / 10)) + a2 * ((1.0 / 24 - a * (5.0 / 208)) + a2 * (35.0 / 2176 - a * (3.0 / 256)));
	const double c1 = (1.0 / 14 - a * (3.0 / 44)) + a2 * ((1.0 / 16 - a * (35.0 / 608)) + a2 * (315.0 / 5888));
	const double c2 = (3.0 / 104 - a * (15.0 / 272)) + a2 * (5.0 / 64);
	const double c3 = 5.0 / 304 - a * (35.0 / 736);
	return factor * std::sqrt(t) * (c0 + e * (c1 + e * (c2 + e * c3)));
}

// Angle swept between x and y, given q = sqrt(f / (u + m)) at both: on one leg, or over the turning point between.
//
// With Xi = sqrt(x - ei), Yi likewise, the angle is 2 RF(U1^2, U2^2, U3^2), Ui (x - y) = Xi Yj Yk + Yi Xj Xk (DLMF
// 19.29.4, one factor constant); past a turning point one root, X2 or X3, changes its sign. Then, E = e3 - e2 and a = X1 + Y1,
//   S = U2 + U3 = a c / (x - y) on one leg, E a / c over the turning point; c^2 = (qx + qy)^2 - (x - y)^2,
//   U2 - U3 = E / S,  U1^2 = U2^2 + e2 + m,
// without cancellation, all real for complex pairs too, and signed (U3 < 0 beyond half a period), so that one first
// duplication, lambda = U2 U3 + U1 S, brings any angle into Carlson's range.
inline double sweep(const Cubic& c, double x, double qx, double y, double qy, bool over) {
	const double ax = std::sqrt(x + c.m), ay = std::sqrt(y + c.m), a = ax + ay, dxy = std::fabs(x - y), K2 = 2 * qx * qy;
	const double G = std::max(x, y) > 1 ? 2 * x * y - (1 + c.m) * (x + y - 2 * c.m) : qx * qx + qy * qy - dxy * dxy;
	double P, M2, U1; // S^2, (U2 - U3)^2
	if (over) {
		if (!(G + K2 > 0))
			return 0; // both at the turning point, to the last digit
		M2 = (G + K2) / (a * a);
		P = c.D * (a * a) / (G + K2); // not D / M2: two divisions at once
		U1 = std::sqrt(0.25 * (P + M2) + 0.5 + 1.5 * c.m);
	} else {
		if (dxy == 0)
			return 0;
		const double inv = 1 / dxy;
		double c2 = G + K2;
		// With h = |x - e|, i = |y - e| from the turning point e, c2 = 2 h i + (h + i) E + 2 sqrt(...): its rounding errors must
		// not take more than all of it where h is next to nothing and E too.
		if (c.D > 0 && !(c2 > 1e-9 * dxy * dxy))
			c2 = std::max(c2, dxy * std::sqrt(c.D));
		P = a * a * (G < 0 && c.D < 0 ? -c.D / (K2 - G) : c2 * (inv * inv));
		M2 = c.D / P;
		U1 = (ax * qy + ay * qx) * inv;
	}
	const double S = std::sqrt(P), X1 = U1 * (U1 + S) + 0.25 * (P - M2);
	return carlson(X1, S * (2 * U1 + S), P * X1, 4, c.B);
}

// cos and sin of 0 <= a < 1e5 to 1e-16, in a third of the C library's instructions: reduced by Cody and Waite's method (pi/2
// in two parts), Taylor's series to where they end in double precision on [-pi/4, pi/4] (terms of the 16th and 17th order).
inline Vec2 circle(double a) {
	const int k = static_cast<int>((a + 0.78539816339744831) * 0.63661977236758134);
	const double x = (a - k * 1.57079632673412561417) - k * 6.07710050650619224932e-11, x2 = x * x, x4 = x2 * x2;
	const double s =
		(-1.0 / 6 + x2 * (1.0 / 120)) + x4 * ((-1.0 / 5040 + x2 * (1.0 / 362880)) +
												 x4 * ((-1.0 / 39916800 + x2 * (1.0 / 6227020800)) - x4 * (1.0 / 1307674368000)));
	const double c = (1.0 / 24 - x2 * (1.0 / 720)) +
					 x4 * ((1.0 / 40320 - x2 * (1.0 / 3628800)) +
							  x4 * ((1.0 / 479001600 - x2 * (1.0 / 87178291200)) + x4 * (1.0 / 20922789888000)));
	const double sine = x + x * x2 * s, cosine = 1 - (0.5 * x2 - x4 * c);
	const Vec2 q = k & 1 ? Vec2{-sine, cosine} : Vec2{cosine, sine};
	return k & 2 ? Vec2{-q.x, -q.y} : q;
}

} // namespace

Cubic::Cubic(double B_, double kappa_) : B(B_), kappa(kappa_), m(negative_root(B, std::sqrt(B))) {
	// D = (1 + m) mu, mu = 1 - 3 m; mu (3 - mu)^2 = 4 kappa: Newton's step gives a small mu the digits of kappa.
	double mu = 1 - 3 * m;
	if (std::fabs(mu) < 1e-7)
		mu = 4.0 / 9 * kappa; // m's own last digit would be more than kappa
	if (std::fabs(mu) < 0.1)
		mu = (mu * mu * (2 * mu - 6) + 4 * kappa) / (3 * (3 - mu) * (1 - mu));
	D = (1 + m) * mu;
}

Launch::Launch(const Vec3& x, const Vec3& given) {
	Vec3 d = given;
	const double d2 = dot(d, d);
	if (!(d2 > 1e-40 && d2 < 1e40)) // lengths near the ends of the exponent's range
		d = scaled(d);
	if (measure<double>(x, d, *this)) {
		outcome = (u < 2.0 / 3 ? outward || kappa > 0 : outward && kappa < 0) ? Outcome::escaped : Outcome::captured;
		return;
	}
	if (!measure<long double>(x, d, *this))
		measure<Quad>(x, d, *this);
	outcome = classify(x, given);
	// A ray so near to critical that quadruple precision does not tell takes a side.
	const bool out = outcome == Outcome::escaped;
	const bool beyond = u < 2.0 / 3 ? (outward ? kappa > 0 : out) : (outward ? !out : kappa > 0);
	if (beyond != (kappa > 0) || kappa == 0)
		kappa = beyond ? 1e-32 : -1e-32;
}

bool escape(const Vec3& x, const Vec3& d, double R, Escape& out) {
	const Launch l(x, d);
	if (l.outcome == Outcome::captured)
		return false;
	if (l.radial) {
		out.phi = 0;
		out.at = out.tangent = l.u * x;
		return true;
	}
	const double u = l.u, y = std::min(1 / R, u);
	double Fy2;
	if (l.B > 1e36) { // b < 1e-18: nothing bends by as much as a rounding error
		Fy2 = l.B;
		out.phi = (u - y) / std::sqrt(l.B);
	} else {
		const Cubic c(l.B, l.kappa);
		Fy2 = value(c, u, l.F2, y);
		out.phi = sweep(c, u, std::sqrt(l.F2 / (u + c.m)), y, std::sqrt(Fy2 / (y + c.m)), !l.outward);
	}
	// At the exit the ray is at an angle off the radial of tangent y / sqrt(f(y)).
	const double size = 1 / std::sqrt(Fy2 + y * y), ca = std::sqrt(Fy2) * size, sa = y * size;
	const Vec2 p = circle(out.phi);
	const Vec3 e2 = l.across * cross(l.axis, x), e1 = u * x;
	out.at = p.x * e1 + p.y * e2;
	out.tangent = (p.x * ca - p.y * sa) * e1 + (p.y * ca + p.x * sa) * e2;
	return true;
}

// The orbit is symmetric about a turning point, e2 or e3, or formally about -m; t is the angle from there. With Jacobi's
// functions of rate t (Byrd & Friedman, Handbook of Elliptic Integrals, 1971, 233.00, 238.00, 239.00, moved to the turning
// point so that its neighbourhood keeps its digits; k'^2 from D, so that it has them near b_c)
//   u = e2 - size (sn/dn)^2   for b > b_c outside the barrier,  rate = sqrt(e3 + m) / 2,  k'^2 = E / (e3 + m)
//   u = e3 + size (sn/cn)^2   for b > b_c inside it,            rate and k the same
//   u = -m + size (1 - cn) / (1 + cn)   for b < b_c,            rate = sqrt(size),  size^2 = f'(-m) = m (3 m + 2)
Exact_Orbit::Exact_Orbit(const Vec3& x, const Vec3& d) : launch_(x, d) {
	const Launch& l = launch_;
	e1_ = l.u * x;
	if (radial()) {
		e2_ = {0, 0, 0};
		return;
	}
	e2_ = l.across * cross(l.axis, x);
	cubic_ = Cubic(l.B, l.kappa);
	const double m = cubic_.m, qx = std::sqrt(l.F2 / (l.u + m));
	const bool outside = l.u < 2.0 / 3;
	double kc2; // k'^2
	if (l.kappa > 0) {
		turns_ = l.outward != outside;
		const double E = std::sqrt(cubic_.D), e3 = 0.5 * (1 + m + E), e2 = l.B / (m * e3);
		turning_ = 0.5 * sweep(cubic_, l.u, qx, l.u, qx, true);
		start_ = turns_ ? -turning_ : turning_;
		kc2 = E / (e3 + m);
		centre_ = outside ? e2 : e3;
		size_ = (centre_ + m) * kc2;
		rate_ = 0.5 * std::sqrt(e3 + m);
	} else {
		size_ = std::sqrt(m * (3 * m + 2));
		start_ = sweep(cubic_, l.u, qx, -m, size_, false);
		way_ = l.outward ? -1 : 1;
		centre_ = -m;
		kc2 = -cubic_.D / (8 * size_ * (size_ + 0.5 + 1.5 * m));
		rate_ = std::sqrt(size_);
	}
	// Descending Landen transformation (DLMF 22.7(i)) until the modulus no longer matters.
	double k2 = 1 - kc2, kc = std::sqrt(kc2), mean = 1;
	while (k2 > 1e-17 && levels_ < 14) {
		const double k = k2 / ((1 + kc) * (1 + kc));
		mean *= 0.5 * (1 + kc);
		k_[levels_] = k;
		k1_[levels_++] = 2 * kc / (1 + kc);
		k2 = k * k;
		kc = 2 * std::sqrt(kc) / (1 + kc);
	}
	base_ = rate_ * mean;
	quarter_ = 1.57079632679489661923 / base_;
}

double Exact_Orbit::swept(double y, bool after) const {
	const double m = cubic_.m, x = launch_.u;
	const double qx = std::sqrt(launch_.F2 / (x + m)), qy = std::sqrt(value(cubic_, x, launch_.F2, y) / (y + m));
	return sweep(cubic_, x, qx, y, qy, after && turns_);
}

double Exact_Orbit::end(double R) const {
	if (radial())
		return 0;
	if (launch_.outcome == Outcome::escaped)
		return swept(std::min(1 / R, launch_.u), turns_);
	if (launch_.u >= 1 && !(turns_ && centre_ < 1))
		return 0;
	return swept(1, turns_);
}

Exact_Orbit::State Exact_Orbit::at(double phi) const {
	double t = start_ + way_ * phi;
	const double sign = t < 0 ? -way_ : way_;
	t = std::fabs(t);
	const bool far = cubic_.kappa < 0 && t > quarter_; // nearer to u = infinity, about which the orbit is symmetric too
	if (far)
		t = 2 * quarter_ - t;
	const Vec2 last = circle(base_ * t);
	double cn = last.x, sn = last.y, dn = 1;
	for (int i = levels_ - 1; i >= 0; i--) {
		const double k = k_[i], q = 1 / (1 + k * sn * sn);
		const double next = (k1_[i] + k * cn * cn) * q;
		cn *= dn * q;
		sn *= (1 + k) * q;
		dn = next;
	}
	const double rate = sign * rate_;
	if (cubic_.kappa < 0) {
		if (far) {
			const double c = (1 + cn) / sn;
			return {centre_ + size_ * c * c, 2 * rate * size_ * dn * c * c / sn};
		}
		const double c = 1 / (1 + cn);
		return {centre_ + size_ * sn * sn * c * c, 2 * rate * size_ * sn * dn * c * c};
	}
	if (launch_.u < 2.0 / 3) {
		const double q = 1 / dn, sd = sn * q;
		return {centre_ - size_ * sd * sd, -2 * rate * size_ * sd * cn * q * q};
	}
	const double q = 1 / cn, sc = sn * q;
	return {centre_ + size_ * sc * sc, 2 * rate * size_ * sc * dn * q * q};
}

} // namespace blackhole
