// SPDX-License-Identifier: AGPL-3.0-or-later
/// Rays in closed form: where one leaves, and its orbit as a function of the swept angle.
///
/// Units as in orbit.h. With u = 1/r and phi the angle swept round the centre, a ray of impact parameter b has
/// (du/dphi)^2 = f(u) = u^3 - u^2 + 1/b^2 (Chandrasekhar, The Mathematical Theory of Black Holes, 1983, chapter 3, eq. 215).
/// Roots of f: -m < 0 always; for b > b_c also e2 < 2/3 < e3, turning points; for b < b_c a complex pair.
/// Everything here is stateless and thread-safe.
#ifndef BLACKHOLE_CLOSED_H
#define BLACKHOLE_CLOSED_H

#include "blackhole/orbit.h"

namespace blackhole {

/// The cubic f and its roots, each difference to the last digits near b_c too.
struct Cubic {
	double B;     ///< 1/b^2, > 0
	double kappa; ///< 1 - (b_c/b)^2: > 0 beyond the critical impact parameter; not 0
	double m;     ///< minus the negative root
	double D;     ///< (e3 - e2)^2; < 0 for a complex pair

	/// B in (0, 1e60); kappa must be consistent with it, but is the finer of the two near b_c.
	Cubic(double B, double kappa);
	Cubic() = default;
};

/// What a ray is, from its start alone, to the last digits about the doubles as given: nearly radial, nearly
/// critical and deep starts are taken in long double or quadruple precision.
struct Launch {
	Vec3 axis;       ///< x cross d, d perhaps rescaled; only its direction is of use
	double r, u;     ///< radius of the start, 1 / r
	double F2;       ///< f(u) = u^2 cot^2 a, a the angle off the outward radial
	double across;   ///< 1 / (r |axis|)
	double B;        ///< as in Cubic
	double kappa;    ///< as in Cubic; its sign agrees with the outcome
	bool outward;    ///< whether r grows at first; so at a turning point outside 1.5, not so at one inside
	bool radial;     ///< b = 0 or below 1e-30 r: B and F2 mean nothing then
	Outcome outcome; ///< as classify() has it

	/// x and d as for classify(); |x| in [1e-6, 1e15].
	Launch(const Vec3& x, const Vec3& d);
};

/// Where and how a ray leaves the sphere of radius R.
struct Escape {
	double phi;   ///< angle swept since the start, radians
	Vec3 at;      ///< unit; R times this is the point
	Vec3 tangent; ///< unit coordinate direction there
};

/// The exit of a ray from x (|x| <= R; rounding beyond is harmless) along d; R > 1.5 may be infinite. Returns false, out
/// unchanged, if classify() has it captured. Error of phi and of the directions below 1e-12 rad, at b_c too, where the start and
/// R leave it that: their own last digits turn a ray by 2e-16 / sqrt(f), f = (du/dphi)^2 there, so rays that are near the photon
/// sphere and nearly critical, or graze the sphere of radius R where they start, are known no better.
bool escape(const Vec3& x, const Vec3& d, double R, Escape& out);

/// The whole orbit of a ray as a function of the angle swept, by Jacobi's functions.
class Exact_Orbit {
public:
	struct State {
		double u;  ///< 1 / r
		double du; ///< du/dphi: the direction has parts -du along the radial and u across it, but for its length
	};

	/// x and d as for classify(). A radial ray sweeps no angle: nothing but radial() and outcome() is of use then,
	/// nor is it for b < 1e-18, where the ray is as good as straight.
	Exact_Orbit(const Vec3& x, const Vec3& d);

	bool radial() const { return launch_.radial || launch_.B > 1e36; }
	Outcome outcome() const { return launch_.outcome; }
	/// Whether b is b_c to the last digits of a double: at() is of no use then.
	bool critical() const { return std::fabs(launch_.kappa) < 1e-14; }
	/// Whether a turning point lies ahead of the start, and the angle swept up to it.
	bool turns() const { return turns_; }
	double turning_angle() const { return turning_; }
	/// The plane as in Orbit: the point at phi is (cos phi e1 + sin phi e2) / u.
	Vec3 e1() const { return e1_; }
	Vec3 e2() const { return e2_; }

	/// Angle swept on reaching u, before the turning point or after it; u must lie on that leg. As exact as escape().
	double swept(double u, bool after) const;
	/// The end of the path: angle swept on leaving the sphere of radius R (as for escape()), or on reaching the horizon. A
	/// captured ray that starts inside the horizon ends where it falls back into it; 0 if it never was outside.
	double end(double R) const;

	/// phi in [0, end]. Errors below 5e-13 (u + (1 + phi) |du|) of u, and 5e-13 (u + |du| + (1 + phi) |u''|) of du, near b_c
	/// too; but phi itself is a double, and one last digit of it, or of the start, grows as exp(phi) while a ray lingers there.
	State at(double phi) const;

private:
	Launch launch_;
	Cubic cubic_;
	Vec3 e1_, e2_;
	bool turns_ = false;
	double turning_ = 0;
	double start_ = 0; // phi at the start, counted from the symmetric point of the orbit (see closed.cpp), and
	int way_ = 1;      // which way it counts from there
	double centre_ = 0, size_ = 0;
	double rate_ = 0;    // Jacobi's argument for each radian
	double quarter_ = 0; // K / rate_
	double base_ = 0;    // Landen's last argument for each radian
	int levels_ = 0;
	double k_[14], k1_[14]; // Landen's moduli k and 1 - k, from the first after the orbit's own
};

} // namespace blackhole

#endif
