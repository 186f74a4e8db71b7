// SPDX-License-Identifier: AGPL-3.0-or-later
/// The classical Runge-Kutta step of fourth order on x'' = -(3/2) h^2 x / r^5, with a step chosen beforehand.
#include "blackhole/method.h"

#include <algorithm>

namespace blackhole {
namespace {

// The step over r, at most: a straight line costs no error, but a longer step could leap through the hole.
constexpr double longest = 0.4;
// What one step of relative length s does wrong, relative to r, is about (constant) F s^5, with F the turn of
// the path over one radius. The constant is set so that the whole path keeps the tolerance with room to spare;
// tests/blackhole/path_test.cpp measures how much.
constexpr double cost = 2.0;

// An error made early grows by about 1 / |b / b_c - 1| on the way round the photon sphere.
double conditioning(double h) { return std::clamp(std::fabs(h / critical_b - 1), 1e-3, 1.0); }

Plan start(const Orbit& orbit, double tolerance) {
	const double h2 = orbit.h * orbit.h;
	return {h2, cost * 1.5 * h2 / (tolerance * conditioning(orbit.h))};
}

Node step(const Node& n, const Plan& plan) {
	const double h2 = plan.h2, r2 = dot(n.p, n.p), r = std::sqrt(r2), r3 = r2 * r;
	// Inside the horizon the energy is what remains of |v|^2 = 1 + h^2 / r^3 when nearly all of it cancels, and the
	// force grows steeper than the step shrinks (the factor 40: as path_test.cpp measures it).
	const double cancels = r2 < 1 ? (1 + h2 / r3) / (1 + h2) * (1 + 40 * (1 - r)) : 1;
	// F = 1.5 h^2 / (r^3 + h^2), times what one step may cost.
	const double s = 1 / (1 / longest + std::sqrt(std::sqrt(plan.scale * cancels / (r3 + h2))));
	const double dl = s * r / length(n.v);

	const Vec2 v2 = n.v + (dl / 2) * n.a;
	const Vec2 a2 = acceleration(n.p + (dl / 2) * n.v, h2);
	const Vec2 v3 = n.v + (dl / 2) * a2;
	const Vec2 a3 = acceleration(n.p + (dl / 2) * v2, h2);
	const Vec2 v4 = n.v + dl * a3;
	const Vec2 a4 = acceleration(n.p + dl * v3, h2);

	Node next;
	next.p = n.p + (dl / 6) * (n.v + 2.0 * v2 + 2.0 * v3 + v4);
	next.v = n.v + (dl / 6) * (n.a + 2.0 * a2 + 2.0 * a3 + a4);
	next.a = acceleration(next.p, h2);
	next.lambda = n.lambda + dl;
	return next;
}

} // namespace

const Integrator rk4 = {start, step};

} // namespace blackhole
