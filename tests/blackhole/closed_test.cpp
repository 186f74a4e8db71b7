// SPDX-License-Identifier: AGPL-3.0-or-later
/// The closed form, against quadrature in fifty digits and in long double. The witness shares no step with it: its roots
/// come by Newton's method in fifty digits, its integrals by Gauss-Kronrod, after substitutions that take both the
/// turning point's root and its neighbour out of the integrand (u = e2 - E sinh^2 s, or u = c + g sinh s).
#include "blackhole/closed.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

using namespace blackhole;
using Exact = boost::multiprecision::cpp_bin_float_50;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double pi = std::acos(-1.0);

/// A ray in fifty digits, about the doubles as given.
struct Witness {
	Exact u, F2, B, kappa, r;
	Exact e1[3], e2[3];
	bool outward, outside;
	Exact m, E, centre; // E: e3 - e2, or the imaginary part g of the pair; centre: e2, e3, or the real part
	Witness(const Vec3& x, const Vec3& d) {
		const Exact a = x.x, b = x.y, c = x.z, e = d.x, f = d.y, g = d.z;
		const Exact n[3] = {b * g - c * f, c * e - a * g, a * f - b * e};
		const Exact r2 = a * a + b * b + c * c, s = a * e + b * f + c * g, n2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
		r = sqrt(r2);
		u = 1 / r;
		F2 = s * s / (r2 * n2);
		outward = s >= 0;
		outside = u < Exact(2) / 3;
		B = F2 + u * u - u * u * u;
		kappa = 1 - Exact(27) / 4 * B;
		const Exact h = r * sqrt(n2), p[3] = {a, b, c};
		for (int i = 0; i < 3; i++) {
			e1[i] = p[i] / r;
			const int j = (i + 1) % 3, k = (i + 2) % 3;
			e2[i] = (n[j] * p[k] - n[k] * p[j]) / h;
		}
		m = sqrt(B); // above the root: Newton's method comes down to it
		for (int i = 0; i < 400; i++) {
			const Exact step = (m * m * (1 + m) - B) / (m * (3 * m + 2));
			m -= step;
			if (abs(step) < m * Exact(1e-44))
				break;
		}
		const Exact D = (1 + m) * (1 - 3 * m);
		if (kappa > 0) {
			E = sqrt(D);
			// e2 e3 = B / m, e2 + e3 = 1 + m
			const Exact e3 = (1 + m + E) / 2;
			centre = outside ? B / m / e3 : e3;
		} else {
			E = sqrt(-D) / 2;
			centre = (1 + m) / 2;
		}
	}
	bool escapes() const { return outside ? outward || kappa > 0 : outward && kappa < 0; }
	bool turns() const { return kappa > 0 && outward != outside; }
	// The variable of integration at y.
	Exact s(const Exact& y) const {
		if (kappa < 0)
			return asinh((y - centre) / E);
		const Exact q = (outside ? centre - y : y - centre) / E;
		return q > 0 ? asinh(sqrt(q)) : Exact(0);
	}
	template <typename Real> Real integral(const Exact& from, const Exact& to) const {
		const Real M(m), C(centre), G(E), a(from < to ? from : to), l(abs(to - from));
		const bool pair = kappa < 0, minus = outside;
		// Over [0, 1]: Boost compares an error that knows nothing of the interval's length.
		auto f = [&](const Real& t) -> Real {
			using std::sinh;
			using std::sqrt;
			const Real q = sinh(Real(a + l * t));
			const Real y = pair ? Real(C + G * q) : minus ? Real(C - G * q * q) : Real(C + G * q * q);
			return (pair ? 1 : 2) / sqrt(y + M);
		};
		const Real tolerance = sizeof(Real) > 16 ? Real(1e-24) : Real(1e-17);
		return l * boost::math::quadrature::gauss_kronrod<Real, 61>::integrate(f, Real(0), Real(1), 12, tolerance);
	}
	template <typename Real> Real swept(const Exact& y, bool after) const {
		if (after && kappa > 0)
			return integral<Real>(0, s(u)) + integral<Real>(0, s(y));
		return integral<Real>(s(u), s(y));
	}
	/// Largest difference of the exit's direction and place.
	template <typename Real> double error(double R, const Escape& e) const {
		const Exact y = 1 / Exact(R) < u ? 1 / Exact(R) : u;
		const Exact phi(swept<Real>(y, turns()));
		const Exact f = y < u && outside && kappa > 0 ? F2 + (u - y) * (u + y - (u * u + u * y + y * y)) : B - y * y + y * y * y;
		const Exact a = atan2(y, sqrt(f > 0 ? f : Exact(0)));
		const double at[3] = {e.at.x, e.at.y, e.at.z}, tangent[3] = {e.tangent.x, e.tangent.y, e.tangent.z};
		Exact worst = 0;
		for (int i = 0; i < 3; i++) {
			const Exact p = cos(phi) * e1[i] + sin(phi) * e2[i] - at[i];
			const Exact q = cos(phi + a) * e1[i] + sin(phi + a) * e2[i] - tangent[i];
			worst = std::max(worst, std::max(Exact(abs(p)), Exact(abs(q))));
		}
		return double(worst);
	}
};

std::mt19937_64 random_bits(11);
double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_bits); }
Vec3 any_direction() {
	std::normal_distribution<double> n;
	return unit({n(random_bits), n(random_bits), n(random_bits)});
}
/// A ray from radius r at an angle a off the outward radial, in general position.
void place(double r, double a, Vec3& x, Vec3& d) {
	const Vec3 e = any_direction(), t = unit(cross(e, any_direction()));
	x = r * e;
	d = (0.5 + uniform()) * (std::cos(a) * e + std::sin(a) * t);
}
double log_uniform(double lo, double hi) { return lo * std::pow(hi / lo, uniform()); }
/// The angle off the outward radial of a ray of impact parameter b at r.
double angle_of(double r, double b, bool outward) {
	const double a = std::asin(std::min(1.0, b / r / std::sqrt(1 + b * b / (r * r * r))));
	return outward ? a : pi - a;
}

struct Worst {
	double error = 0, r = 0, R = 0, b = 0;
	int rays = 0, captured = 0;
	void print(const char* name) const {
		std::printf("[ closed   ] %-44s %6d rays (%d captured): worst %.2g at r %.6g R %.3g b/b_c-1 %.2g\n", name, rays, captured,
			error, r, R, b);
	}
};

/// Compares one ray; outcome too.
template <typename Real> void compare(Worst& w, const Vec3& x, const Vec3& d, double R) {
	const Witness witness(x, d);
	Escape e;
	const bool out = escape(x, d, R, e);
	ASSERT_EQ(out, witness.escapes());
	ASSERT_EQ(out, classify(x, d) == Outcome::escaped);
	w.rays++;
	if (!out) {
		w.captured++;
		return;
	}
	ASSERT_TRUE(std::isfinite(e.phi) && std::isfinite(e.tangent.x));
	const double error = witness.error<Real>(R, e);
	if (!(error <= w.error))
		w.error = error, w.r = length(x), w.R = R, w.b = double(1 / sqrt(witness.B)) / critical_b - 1;
}

template <typename Real, typename Ray> double regime(const char* name, int n, Ray ray) {
	Worst w;
	for (int i = 0; i < n && !testing::Test::HasFatalFailure(); i++) {
		Vec3 x, d;
		const double R = ray(x, d);
		compare<Real>(w, x, d, R);
	}
	w.print(name);
	return w.error;
}

double sphere(double r) {
	const double k = uniform();
	return k < 0.15 ? infinity : k < 0.25 ? std::max(r, 1.6) : std::max(r, 2.0) * std::min(1e12, log_uniform(1, 1e6));
}

} // namespace

TEST(Closed, AnyDirectionFromAnywhere) {
	auto ray = [](Vec3& x, Vec3& d) {
		const double r = 1.0001 + log_uniform(1e-4, 1e9);
		place(r, std::acos(1 - 2 * uniform()), x, d);
		return sphere(r);
	};
	EXPECT_LT(regime<long double>("any direction, r 1.0002 to 1e9", 4000, ray), 1e-12);
	EXPECT_LT(regime<Exact>("the same in 50 digits", 100, ray), 1e-12);
}

TEST(Closed, TowardsTheHole) {
	auto ray = [](Vec3& x, Vec3& d) {
		const double r = log_uniform(1.51, 1e9);
		place(r, angle_of(r, std::min(6 * uniform(), 0.999 * r / std::sqrt(1 - 1 / r)), uniform() < 0.2), x, d);
		return sphere(r);
	};
	EXPECT_LT(regime<long double>("b from 0 to 6", 4000, ray), 1e-12);
	EXPECT_LT(regime<Exact>("the same in 50 digits", 100, ray), 1e-12);
}

TEST(Closed, AllImpactParameters) {
	auto ray = [](Vec3& x, Vec3& d) {
		const double b = log_uniform(1e-12, 1e6), r = std::max(1.51, b) * (1 + log_uniform(1e-9, 1e3));
		place(r, angle_of(r, b, uniform() < 0.5), x, d);
		return sphere(r);
	};
	EXPECT_LT(regime<long double>("b from 1e-12 to 1e6", 3000, ray), 1e-12);
	EXPECT_LT(regime<Exact>("the same in 50 digits", 60, ray), 1e-12);
}

TEST(Closed, InsideTheHorizon) {
	auto ray = [](Vec3& x, Vec3& d) {
		const double r = log_uniform(1e-3, 1);
		// Just below the escaping b mostly; falling observers see all of it.
		place(r, angle_of(r, critical_b * std::min(1.2, log_uniform(1e-3, 2)), true), x, d);
		return sphere(r);
	};
	EXPECT_LT(regime<long double>("starts inside the horizon", 1500, ray), 1e-12);
	EXPECT_LT(regime<Exact>("the same in 50 digits", 60, ray), 1e-12);
}

TEST(Closed, NearTheCriticalImpactParameter) {
	for (double far : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
		auto ray = [far](Vec3& x, Vec3& d) {
			double r = uniform() < 0.3 ? 1.02 + 0.4 * uniform() : log_uniform(1.6, 1e4);
			place(r, angle_of(r, critical_b * (1 + far * (2 * uniform() - 1)), r < 1.5 || uniform() < 0.2), x, d);
			return sphere(r);
		};
		char name[80];
		std::snprintf(name, sizeof name, "|b/b_c - 1| < %g", far);
		EXPECT_LT(regime<Exact>(name, 30, ray), 1e-12);
	}
}

namespace {

/// The orbit at phi = the witness's angle swept at u, on a leg; the error over what a wrong last digit may do:
/// of phi, of the whole phase, of the start.
double orbit_error(const Exact_Orbit& o, const Witness& w, const Exact& y, bool after) {
	const Exact phi = w.swept<Exact>(y, after);
	const auto s = o.at(double(phi));
	const Exact f = w.B - y * y + y * y * y;
	const double du = double(sqrt(f > 0 ? f : Exact(0))) * (w.outward != after ? -1 : 1);
	// Second derivative u'' = 1.5 u^2 - u, for what is left of the error of phi at a turning point.
	const double u = double(y), dd = std::fabs(1.5 * u * u - u), scale = 1 + double(phi) + o.turning_angle();
	return std::max(
		std::fabs(double(s.u - y)) / (u + scale * (std::fabs(du))), std::fabs(s.du - du) / (std::fabs(du) + scale * dd + u));
}

template <typename Ray> double orbit_regime(const char* name, int n, Ray ray) {
	double worst = 0, worst_r = 0, worst_b = 0, worst_phi = 0;
	for (int i = 0; i < n; i++) {
		Vec3 x, d;
		const double R = ray(x, d);
		const Witness w(x, d);
		const Exact_Orbit o(x, d);
		EXPECT_EQ(o.outcome() == Outcome::escaped, w.escapes());
		EXPECT_EQ(o.turns(), w.turns());
		if (o.outcome() == Outcome::escaped) {
			Escape e;
			EXPECT_TRUE(escape(x, d, R, e));
			EXPECT_EQ(o.end(R), e.phi);
		} else if (w.u < 1 || (w.turns() && w.centre < 1)) {
			const auto s = o.at(o.end(R)); // on the horizon, going in
			EXPECT_NEAR(s.u, 1, 1e-12 * (1 + s.du * (1 + o.end(R))));
			EXPECT_GT(s.du, 0);
		} else {
			EXPECT_EQ(o.end(R), 0);
		}
		for (int j = 0; j < 4; j++) {
			// Places on either leg: between the start and the turning point, or the turning point and the end.
			const bool after = w.turns() && j >= 2;
			Exact end = o.outcome() == Outcome::escaped ? 1 / Exact(R) : Exact(w.u > 1 ? w.u : Exact(1));
			if (w.turns() && (!after || w.u > 1))
				end = w.centre;
			const Exact from = after ? w.centre : w.u;
			const Exact y = from + (end - from) * Exact(j == 3 ? 1.0 : uniform());
			const double error = orbit_error(o, w, y, after);
			if (!(error <= worst))
				worst = error, worst_r = length(x), worst_b = double(1 / sqrt(w.B)) / critical_b - 1,
				worst_phi = double(w.swept<Exact>(y, after));
		}
	}
	std::printf("[ closed   ] u(phi), %-40s %5d rays: worst %.2g at r %.6g b/b_c-1 %.2g phi %.3g\n", name, n, worst, worst_r,
		worst_b, worst_phi);
	return worst;
}

} // namespace

TEST(Closed, RadialRays) {
	for (double scale : {1.0, 1e200, 1e-200})
		for (double r : {1e-3, 0.5, 1.0, 1.2, 1.5, 3.0, 1e9}) {
			Escape e;
			ASSERT_TRUE(escape({0, r, 0}, {0, scale, 0}, infinity, e));
			EXPECT_EQ(e.phi, 0);
			EXPECT_EQ(e.tangent.y, 1);
			EXPECT_EQ(e.at.y, 1);
			EXPECT_FALSE(escape({0, r, 0}, {0, -scale, 0}, infinity, e) && r >= 1);
			EXPECT_TRUE(Exact_Orbit({0, r, 0}, {0, scale, 0}).radial());
			EXPECT_EQ(Exact_Orbit({0, r, 0}, {0, scale, 0}).end(1e10), 0);
			// And next to radial: the angle swept is b (u - u_R).
			for (double s : {1e-12, 1e-17, 1e-25, 1e-40, 1e-100, 1e-160, 1e-300}) {
				ASSERT_TRUE(escape({0, r, 0}, {scale > 1 ? 0 : scale * s, scale, 0}, 1e10, e));
				EXPECT_NEAR(e.phi, 0, 1e-11);
				EXPECT_NEAR(e.tangent.y, 1, 1e-15);
				if (s > 1e-29 && scale == 1) {
					EXPECT_NEAR(e.phi / (r * s * (1 / r - 1e-10)), 1, 1e-10) << r << " " << s;
				}
			}
		}
}

TEST(Closed, StartsAtTheTurningPoint) {
	Worst w;
	for (double r : {1.5000001, 1.51, 2.0, 3.0, 10.0, 1e3, 1e9})
		for (double R : {r * 1.0000001, 1.01 * r, 2 * r, 1e3 * r, infinity})
			for (double off : {0.0, 1e-300, 1e-20, -1e-20, 1e-12, -1e-12, 1e-8, -1e-8}) {
				Worst one;
				compare<Exact>(one, {0, r, 0}, {0, off, 2}, R);
				EXPECT_LT(one.error, 3e-15 / std::min(1e-3, std::min(r / 1.5 - 1, std::sqrt(R / r - 1))))
					<< r << " " << R << " " << off;
				w.rays++, w.error = std::max(w.error, one.error);
			}
	w.print("starts at the turning point");
}

// Where a ray starts or ends on the sphere of radius R: no sweep, the ray's own direction.
TEST(Closed, StartsOnTheSphere) {
	for (double r : {1.6, 3.0, 100.0, 1e9}) {
		Escape e;
		const Vec3 x{0, r, 0}, d = unit({0, 1, 1});
		for (double R : {r, r * (1 - 1e-15)}) {
			ASSERT_TRUE(escape(x, d, R, e));
			EXPECT_NEAR(e.phi, 0, 1e-14);
			EXPECT_LT(length(e.tangent - d), 1e-15);
		}
		// Tangential, and into the sphere by as little as the last digit.
		for (double s : {0.0, -1e-16, -1e-9}) {
			ASSERT_TRUE(escape(x, {0, s, 1}, r, e));
			EXPECT_NEAR(e.phi, 0, 1e-7);
		}
	}
}

TEST(Closed, AroundThePhotonSphere) {
	Worst w;
	double relative = 0;
	for (int i = 0; i < 300; i++) {
		const double side = uniform() < 0.5 ? 1 : -1, r = uniform() < 0.1 ? 1.5 : 1.5 * (1 + side * log_uniform(1e-15, 1e-2));
		Vec3 x, d;
		const double a = pi / 2 - (r < 1.5 ? 1 : uniform() < 0.5 ? -1 : 1) * log_uniform(1e-15, 1);
		place(r, a, x, d);
		const double R = std::max(1.5 * (1 + (uniform() < 0.5 ? 1e-9 : log_uniform(1e-9, 1))), length(x));
		Worst one;
		compare<Exact>(one, x, d, R);
		const Witness v(x, d);
		// A last digit of u or of u_R is this much of an angle.
		const double y = 1 / R, f = std::min(double(v.F2), double(v.B) - y * y + y * y * y);
		const double digit = 2e-16 * (1 / std::sqrt(std::max(1e-30, f)) + 1);
		relative = std::max(relative, one.error / digit);
		w.rays++, w.captured += one.captured;
		if (one.error > w.error)
			w.error = one.error, w.r = r, w.R = R, w.b = one.b;
	}
	w.print("around the photon sphere");
	std::printf("[ closed   ] ... over a last digit of r: %.3g\n", relative);
	EXPECT_LT(relative, 1000);
}

// Single roundings across the critical direction: the outcome is classify()'s and nothing is lost.
TEST(Closed, AtTheEdge) {
	Worst w;
	for (double r : {1000.0, 25.0, 3.0, 2.0, 1.5, 1.4, 1.01, 0.7}) {
		const double k = (1.5 - r) * std::sqrt((r + 3) / (r * r * r + 6.75));
		for (int i = -20; i <= 20; i++) {
			double s = std::sqrt(1 - k * k);
			for (int j = 0; j < std::abs(i); j++)
				s = std::nextafter(s, i > 0 ? 2 : 0);
			const Vec3 x{r, 0, 0}, d{k, s, 0};
			if (r == 1.5 || uniform() < 0.3)
				compare<Exact>(w, x, d, 100 * r);
			const Exact_Orbit o(x, d);
			const double end = o.end(1000 * r);
			EXPECT_TRUE(std::isfinite(end));
			EXPECT_TRUE(std::isfinite(o.at(0.5 * end).u));
		}
	}
	w.print("single roundings about b_c");
	EXPECT_LT(w.error, 1e-12);
}

TEST(Exact_Orbit, FollowsThePath) {
	EXPECT_LT(orbit_regime("towards the hole", 100,
				  [](Vec3& x, Vec3& d) {
					  const double r = log_uniform(1.51, 1e4);
					  place(r, angle_of(r, std::min(6 * uniform(), 0.999 * r / std::sqrt(1 - 1 / r)), uniform() < 0.2), x, d);
					  return sphere(r);
				  }),
		5e-13);
	EXPECT_LT(orbit_regime("any direction", 100,
				  [](Vec3& x, Vec3& d) {
					  const double r = 1.0001 + log_uniform(1e-4, 1e6);
					  place(r, std::acos(1 - 2 * uniform()), x, d);
					  return sphere(r);
				  }),
		5e-13);
	EXPECT_LT(orbit_regime("starts inside the horizon", 60,
				  [](Vec3& x, Vec3& d) {
					  const double r = log_uniform(1e-3, 1);
					  place(r, angle_of(r, critical_b * std::min(1.2, log_uniform(1e-3, 2)), true), x, d);
					  return sphere(r);
				  }),
		5e-13);
	for (double far : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
		char name[80];
		std::snprintf(name, sizeof name, "|b/b_c - 1| < %g", far);
		EXPECT_LT(orbit_regime(name, 30,
					  [far](Vec3& x, Vec3& d) {
						  const double r = uniform() < 0.3 ? 1.02 + 0.4 * uniform() : log_uniform(1.6, 1e4);
						  place(r, angle_of(r, critical_b * (1 + far * (2 * uniform() - 1)), r < 1.5 || uniform() < 0.2), x, d);
						  return sphere(r);
					  }),
			5e-13);
	}
}
