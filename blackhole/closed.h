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
	Vec3 axis;      ///< x cross d, d perhaps rescaled; only its direction is of use
	double r, u;    ///< radius of the start, 1 / r
	double F2;      ///< f(u) = u^2 cot^2 a, a the angle off the outward radial
	double across;  ///< 1 / (r |axis|)
	double B;       ///< as in Cubic
	double kappa;   ///< as in Cubic; its sign agrees with the outcome
	bool outward;   ///< whether r grows at first; so at a turning point outside 1.5, not so at one inside
	bool radial;    ///< b = 0 or below 1e-30 r: B and F2 mean nothing then
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
/// unchanged, if classify() has it captured. Error of phi and directions below 1e-12 rad, at b_c too, but for rays that also
/// start or end within 1e-4 of the photon sphere: there the error is that of the start's own last digit.
bool escape(const Vec3& x, const Vec3& d, double R, Escape& out);

/// The whole orbit of a ray as a function of the angle swept, by Jacobi's functions.
class Exact_Orbit {
public:
	struct State {
		double u;  ///< 1 / r
		double du; ///< du/dphi; the direction is -du, u along and across the radial, to scale
	};

	/// x and d as for classify(), not radial: a radial ray sweeps no angle (see radial()).
	Exact_Orbit(const Vec3& x, const Vec3& d);

	bool radial() const { return launch_.radial; }
	Outcome outcome() const { return launch_.outcome; }
	/// Whether the orbit has a turning point ahead of the start.
	bool turns() const { return turns_; }
	/// Angle swept on reaching u: before the turning point, or after it (the only one that exists if R is on the way out of
	/// an escaping ray that came in; at the same u both exist). u must lie on that leg.
	double swept(double u, bool after) const;
	/// The end of the path: angle swept on leaving the sphere of radius R, or on reaching the horizon. A captured ray
	/// that starts inside the horizon ends where it comes back to it, at once if it never is outside.
	double end(double R) const;

	/// phi in [0, end]. Error of u below 1e-14 (u + |du| (1 + phi)) times what a start wrong in its last digit makes of it:
	/// it grows as exp(turning angle) near b_c.
	State at(double phi) const;

private:
	Launch launch_;
	Cubic cubic_;
	bool turns_ = false;
	double k1_[12], k1c_[12]; // Landen's moduli and one minus them
	int levels_ = 0;
	double rate_ = 0;  // Jacobi's argument for each radian
	double base_ = 0;  // the same, of Landen's last level (a plain angle)
	double quarter_ = 0; // the real quarter period K over rate_: radians
	double start_ = 0; // phi at the start, counted from the nearest place where the orbit is symmetric
	double size_ = 0;
};

} // namespace blackhole

#endif
