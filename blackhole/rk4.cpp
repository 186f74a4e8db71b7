// SPDX-License-Identifier: AGPL-3.0-or-later
/// The classical Runge-Kutta step of fourth order on Binet's equation, with a step chosen beforehand.
#include "blackhole/method.h"

namespace blackhole {
namespace {

// The longest step where the path is nearly straight, in the equation's own time: its frequency is k sqrt(1 + 3u) at most.
constexpr double longest = 0.55;
// What one step of relative length h does wrong is about a constant times h^5. The constant is set so that the whole path
// keeps the tolerance with room to spare; tests/blackhole/path_test.cpp measures how much.
constexpr double cost = 0.04;

Plan start(const Orbit& orbit, double tolerance) {
	return {orbit.k * orbit.k, orbit.h * orbit.h, cost / (tolerance * conditioning(orbit.h)), 0};
}

Node step(const Node& n, Plan& plan) {
	const double k2 = plan.k2, u = n.u;
	const double rate = plan.rate * cancellation(u, plan.b2);
	const double frequency = std::sqrt(k2 * (1 + 3 * u));
	// A radial ray is a straight line in s: no error, but the piece must not leap far beyond the horizon. Deep inside it may:
	// halving u is near enough.
	const double h = 1 / (frequency * (1 / longest + std::sqrt(std::sqrt(rate))) + (u > 2 ? 2 / u : 1));

	const double half = 0.5 * h, v = half * n.w;
	const double a2 = acceleration(u + v, k2);
	const double a3 = acceleration(u + v + half * half * n.a, k2);
	const double a4 = acceleration(u + 2 * v + half * h * a2, k2);

	Node next;
	next.s = n.s + h;
	next.u = u + h * (n.w + h / 6 * (n.a + a2 + a3));
	next.w = n.w + h / 6 * (n.a + 2 * (a2 + a3) + a4);
	next.a = acceleration(next.u, k2);
	return next;
}

} // namespace

const Integrator rk4 = {start, step};

} // namespace blackhole
