// SPDX-License-Identifier: AGPL-3.0-or-later
/// The seam between a path and the ways to compute it.
#ifndef BLACKHOLE_METHOD_H
#define BLACKHOLE_METHOD_H

#include "blackhole/orbit.h"
#include "blackhole/piece.h"

namespace blackhole {

enum class Method { rk4, dopri5, exact };

/// Names as the scene language has them, in the order of the enumeration; for messages and look-ups.
constexpr const char* method_names[] = {"rk4", "dopri5", "exact"};

/// Finds a method by name. Returns false if there is none.
bool find_method(const char* name, Method& method);

/// Binet's equation in the parameter s: d2u/ds2 = k^2 (3/2 u^2 - u).
inline double acceleration(double u, double k2) { return k2 * u * (1.5 * u - 1); }

/// What a method needs to know of a whole path: computed once for each ray.
struct Plan {
	double k2;   ///< square of the orbit's k
	double b2;   ///< square of its impact parameter
	double rate; ///< the method's own measure of how small its steps must be
	double next; ///< the step it will try next, if it decides on the way
};

/// A way to compute paths step by step. start makes the plan (tolerance: radians, [1e-9, 0.1], of the whole path, as
/// docs/manual.md has it); step goes from one node to the next. A method chooses its own step, so that neighbouring rays are
/// computed alike, to the tolerance, and pictures do not tear.
struct Integrator {
	Plan (*start)(const Orbit& orbit, double tolerance);
	Node (*step)(const Node& from, Plan& plan);
};

/// The steps of a method; for Method::exact, which needs none, those of rk4 (it follows radial rays so: straight lines).
const Integrator& integrator_of(Method method);

/// rk4.cpp: the classical Runge-Kutta method of fourth order, with steps chosen beforehand.
extern const Integrator rk4;
/// dopri5.cpp: Dormand and Prince's pair of orders 5 and 4, with steps by the error it finds.
extern const Integrator dopri5;

/// An error made early grows by about 1 / |b / b_c - 1| on the way round the photon sphere; within 0.1 % nothing is promised.
inline double conditioning(double b) { return std::fmin(1.0, std::fmax(1e-3, std::fabs(b / critical_b - 1))); }

/// What the tolerance must be divided by inside the horizon, where the energy is what remains of |v|^2 = 1 + b^2 u^3 when
/// nearly all of it cancels. 1 outside. Beyond 1e8 rounding has taken what steps could save.
inline double cancellation(double u, double b2) {
	return u > 1 ? std::fmin(1e8, (1 + b2 * u * u * u) / (1 + b2)) * (1 + 40 * (1 - 1 / u)) : 1;
}

} // namespace blackhole

#endif
