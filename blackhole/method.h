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

/// How the acceleration follows from the position; h2 is the square of the conserved h.
inline Vec2 acceleration(Vec2 p, double h2) {
	const double r2 = dot(p, p);
	return (-1.5 * h2 / (r2 * r2 * std::sqrt(r2))) * p;
}

/// What a method needs to know of a whole path: computed once for each ray.
struct Plan {
	double h2;    ///< square of the conserved h
	double scale; ///< the method's own measure of how small its steps must be
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
