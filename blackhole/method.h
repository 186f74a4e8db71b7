// SPDX-License-Identifier: AGPL-3.0-or-later
/// The seam between a path and the ways to compute it.
#ifndef BLACKHOLE_METHOD_H
#define BLACKHOLE_METHOD_H

#include "blackhole/orbit.h"
#include "blackhole/piece.h"

namespace blackhole {

enum class Method { rk4 };

/// Names as the scene language has them, in the order of the enumeration; for messages and look-ups.
constexpr const char* method_names[] = {"rk4"};

/// Finds a method by name. Returns false if there is none.
bool find_method(const char* name, Method& method);

/// Binet's equation in the parameter s: d2u/ds2 = k^2 (3/2 u^2 - u).
inline double acceleration(double u, double k2) { return k2 * u * (1.5 * u - 1); }

/// What a method needs to know of a whole path: computed once for each ray.
struct Plan {
	double k2;   ///< square of the orbit's k
	double b2;   ///< square of its impact parameter
	double rate; ///< the method's own measure of how small its steps must be
};

/// A way to compute paths. start makes the plan (tolerance: radians, [1e-9, 0.1], of the whole path, as docs/manual.md
/// has it); step goes from one node to the next. A method chooses its own step, as a continuous function of the node and
/// the orbit, so that neighbouring rays are computed alike and pictures do not tear.
struct Integrator {
	Plan (*start)(const Orbit& orbit, double tolerance);
	Node (*step)(const Node& from, const Plan& plan);
};

const Integrator& integrator_of(Method method);

/// rk4.cpp: the classical Runge-Kutta method of fourth order.
extern const Integrator rk4;

} // namespace blackhole

#endif
