// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/oracle.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <cmath>

namespace oracle {
namespace {

using blackhole::Vec3;
const Real pi = 3.14159265358979323846264338327950288L;

// Gauss-Kronrod with bisection; the integrands below are analytic on their ranges.
template <typename F> Real integrate(F f, Real a, Real b) {
	if (a == b)
		return 0;
	return boost::math::quadrature::gauss_kronrod<Real, 61>::integrate(f, a, b, 12, 1e-14L);
}

struct Start {
	Vec3 e1, e2;
	Real r, a;
	Start(const Vec3& x, const Vec3& d) {
		r = std::sqrt(Real(x.x) * x.x + Real(x.y) * x.y + Real(x.z) * x.z);
		e1 = unit(x);
		const Vec3 n = unit(d), across = n - dot(n, e1) * e1;
		const Vec3 c = cross(x, d);
		const Real s = std::sqrt(Real(c.x) * c.x + Real(c.y) * c.y + Real(c.z) * c.z);
		a = std::atan2(s, Real(x.x) * d.x + Real(x.y) * d.y + Real(x.z) * d.z);
		e2 = length(across) > 1e-300 ? unit(across) : unit(cross(e1, std::fabs(e1.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
	}
	Vec3 at(Real radius, Real phi) const { return double(radius * std::cos(phi)) * e1 + double(radius * std::sin(phi)) * e2; }
};

} // namespace

Ray::Ray(Real r0, Real a) : r0_(r0) {
	const Real s = std::sin(a);
	b_ = r0 * s / std::sqrt(1 - s * s / r0);
	outward_ = a < pi / 2;
	escapes_ = std::cos(a) > (1.5L - r0) * std::sqrt((r0 + 3) / (r0 * r0 * r0 + 6.75L));
	// Turning points exist for b > b_c: two positive roots of 1/b^2 - u^2 + u^3, either side of u = 2/3.
	const Real bc2 = 6.75L;
	barrier_ = b_ * b_ > bc2;
	if (barrier_) {
		// Trigonometric solution of the cubic in w = u - 1/3.
		const Real q = 1 - 2 * bc2 / (b_ * b_);
		const Real t = std::acos(std::clamp<Real>(q, -1, 1)) / 3;
		Real roots[3];
		for (int k = 0; k < 3; k++) {
			roots[k] = (1 + 2 * std::cos(t - 2 * pi * k / 3)) / 3;
			for (int i = 0; i < 4; i++) { // polish, where the root is not double
				const Real u = roots[k], f = u * u * (u - 1) + 1 / (b_ * b_), df = u * (3 * u - 2);
				if (std::fabs(df) > 1e-9L)
					roots[k] -= f / df;
			}
		}
		std::sort(roots, roots + 3); // negative, outer turning point's u, inner's
		const bool outside = r0 > 1.5L;
		up_ = outside ? roots[1] : roots[2];
		u1_ = roots[0];
		u3_ = outside ? roots[2] : roots[1];
		// From outside the hole's barrier a ray that goes in turns; from inside one that goes out does.
		turns_ = outside ? !outward_ : outward_;
		if (turns_)
			turning_angle_ = integral(1 / r0_, up_);
	}
}

// Integral of du / sqrt(1/b^2 - u^2 + u^3) between two u, positive.
Real Ray::integral(Real from, Real to) const {
	const Real b2 = b_ * b_;
	if (barrier_) {
		// u = up - s t^2: the root at the turning point cancels.
		const Real s = up_ > u3_ ? -1 : 1; // inside the barrier u comes down to the turning point
		auto f = [&](Real t) {
			const Real u = up_ - s * t * t;
			return 2 / std::sqrt(std::fabs((u - u1_) * (u - u3_)));
		};
		const Real t0 = std::sqrt(std::max<Real>(0, s * (up_ - from))), t1 = std::sqrt(std::max<Real>(0, s * (up_ - to)));
		return std::fabs(integrate(f, std::min(t0, t1), std::max(t0, t1)));
	}
	// In log u: a far start makes u span many decades.
	auto f = [&](Real l) {
		const Real u = std::exp(l);
		return u / std::sqrt(1 / b2 - u * u + u * u * u);
	};
	const Real lo = std::log(std::min(from, to)), hi = std::log(std::max(from, to));
	// Split where a near-critical ray lingers.
	const Real mid = std::log(2.0L / 3);
	if (lo < mid && mid < hi)
		return integrate(f, lo, mid) + integrate(f, mid, hi);
	return integrate(f, lo, hi);
}

Real Ray::swept(Real r, int leg) const {
	if (b_ == 0)
		return 0;
	if (!turns_ || leg == 0)
		return integral(1 / r0_, 1 / r);
	return turning_angle_ + integral(up_, 1 / r);
}

Real Ray::angle(Real r, int leg) const {
	const Real f = 1 - 1 / r;
	const Real radial = std::sqrt(std::max<Real>(0, 1 - b_ * b_ * f / (r * r)));
	const bool out = turns_ && leg == 1 ? !outward_ : outward_;
	return std::atan2(b_ / r, out ? radial : -radial);
}

Real Ray::distance(Real r, Real phi) const {
	const int leg = turns_ && phi > turning_angle_ ? 1 : 0;
	if (turns_) {
		const Real past = up_ > u3_ ? r - 1 / up_ : 1 / up_ - r; // > 0: beyond the turning point
		if (past >= 0)
			return std::hypot(past, 0.0L);
	}
	const Real a = angle(r, leg);
	const Real off = swept(r, leg) - phi;
	return std::fabs(r * off * std::cos(a));
}

bool exit_direction(const Vec3& x, const Vec3& d, double R, Vec3& direction, Vec3& position, double* b) {
	const Start start(x, d);
	const Ray ray(start.r, start.a);
	if (b)
		*b = double(ray.b());
	if (!ray.escapes())
		return false;
	const int leg = ray.turns() ? 1 : 0;
	const Real phi = ray.swept(R, leg), a = ray.angle(R, leg);
	position = start.at(R, phi);
	direction = start.at(1, phi + a);
	return true;
}

Vec3 point(const Vec3& x, const Vec3& d, double r, int leg) {
	const Start start(x, d);
	const Ray ray(start.r, start.a);
	return start.at(r, ray.swept(r, leg));
}

bool first_hit(const Vec3& x, const Vec3& d, double R, const std::function<double(const Vec3&)>& f, Vec3& point, Vec3& tangent) {
	const Start start(x, d);
	const Ray ray(start.r, start.a);
	const Real end = ray.turns() ? ray.turning_radius() : ray.escapes() ? Real(R) : Real(1);
	// s in [0, 1]: to the turning point or the end; in [1, 2]: from the turning point on, evenly spaced in the square root of
	// the distance from it, where the path is smooth.
	auto radius = [&](Real s) -> Real {
		if (!ray.turns())
			return start.r * std::pow(end / start.r, s);
		const Real last = ray.escapes() ? Real(R) : Real(1);
		return s < 1 ? end + (start.r - end) * (1 - s) * (1 - s) : end + (last - end) * (s - 1) * (s - 1);
	};
	auto at = [&](Real s) { return start.at(radius(s), ray.swept(radius(s), s >= 1 ? 1 : 0)); };
	const Real most = ray.turns() ? 2 : 1, step = 1.0L / 200;
	const double first = f(at(step / 50));
	for (Real s = step / 50; s < most; s += step) {
		const Real next = std::min(s + step, most);
		if ((f(at(next)) > 0) == (first > 0))
			continue;
		Real lo = s, hi = next;
		for (int i = 0; i < 60; i++) {
			const Real mid = (lo + hi) / 2;
			((f(at(mid)) > 0) == (first > 0) ? lo : hi) = mid;
		}
		const int leg = lo >= 1 ? 1 : 0;
		const Real r = radius(lo), phi = ray.swept(r, leg);
		point = start.at(r, phi);
		tangent = start.at(1, phi + ray.angle(r, leg));
		return true;
	}
	return false;
}

std::vector<Vec3> polyline(const Vec3& x, const Vec3& d, double R, int n) {
	const Start start(x, d);
	const Ray ray(start.r, start.a);
	const Real last = ray.escapes() ? Real(R) : Real(1);
	std::vector<Vec3> points;
	// Evenly spaced in the square root of the distance from the turning point, where the path is smooth.
	if (ray.turns()) {
		const Real turn = ray.turning_radius();
		for (int i = 0; i < n; i++) {
			const Real s = 1 - Real(i) / n, r = turn + (start.r - turn) * s * s;
			points.push_back(start.at(r, ray.swept(r, 0)));
		}
		for (int i = 0; i <= n; i++) {
			const Real s = Real(i) / n, r = turn + (last - turn) * s * s;
			points.push_back(start.at(r, ray.swept(r, 1)));
		}
		return points;
	}
	for (int i = 0; i <= n; i++) {
		const Real r = start.r * std::pow(last / start.r, Real(i) / n);
		points.push_back(start.at(r, ray.swept(r, 0)));
	}
	return points;
}

double distance(const Vec3& x, const Vec3& d, const Vec3& q, int turns) {
	const Start start(x, d);
	const Ray ray(start.r, start.a);
	double phi = std::atan2(dot(q, start.e2), dot(q, start.e1));
	if (phi < 0)
		phi += double(2 * pi);
	const double off_plane = dot(q, cross(start.e1, start.e2));
	return std::hypot(double(ray.distance(length(q), phi + double(2 * pi) * turns)), off_plane);
}

} // namespace oracle
