// SPDX-License-Identifier: AGPL-3.0-or-later
/// The embedded pair of orders 5 and 4 on Binet's equation, with steps by the error it finds.
///
/// Dormand & Prince, A family of embedded Runge-Kutta formulae, J. Comp. Appl. Math. 6, 1980, table 2 (RK5(4)7M); step control:
/// Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, section II.4.
#include "blackhole/method.h"

#include <algorithm>

namespace blackhole {
namespace {

// Of the tolerance, what one step may do wrong; the error found is that of the fourth order, the fifth is kept.
constexpr double share = 0.05;
// The longest step, in the equation's own time, and what the quintic between nodes allows: its error is of sixth order.
constexpr double longest = 0.8;
double longest_for(double tolerance) { return std::min(longest, 2 * std::cbrt(std::sqrt(20 * tolerance))); }

Plan start(const Orbit& orbit, double tolerance) {
	// rate holds the tolerance here.
	return {orbit.k * orbit.k, orbit.h * orbit.h, tolerance * conditioning(orbit.h), 0.1};
}

Node step(const Node& n, Plan& plan) {
	const double k2 = plan.k2, u = n.u, w = n.w;
	const double allowed = share * plan.rate / cancellation(u, plan.b2);
	// The last term as in rk4.cpp.
	const double most = 1 / (std::sqrt(k2 * (1 + 3 * u)) / longest_for(plan.rate) + (u > 2 ? 2 / u : 1));
	double h = std::min(plan.next, most);
	for (int tries = 0;; tries++) {
		// u and w go through the stages as one system: u' = w, w' = acceleration(u).
		const double f1 = n.a;
		const double w2 = w + h / 5 * f1, f2 = acceleration(u + h / 5 * w, k2);
		const double w3 = w + h * (3.0 / 40 * f1 + 9.0 / 40 * f2), f3 = acceleration(u + h * (3.0 / 40 * w + 9.0 / 40 * w2), k2);
		const double w4 = w + h * (44.0 / 45 * f1 - 56.0 / 15 * f2 + 32.0 / 9 * f3),
					 f4 = acceleration(u + h * (44.0 / 45 * w - 56.0 / 15 * w2 + 32.0 / 9 * w3), k2);
		const double w5 = w + h * (19372.0 / 6561 * f1 - 25360.0 / 2187 * f2 + 64448.0 / 6561 * f3 - 212.0 / 729 * f4),
					 f5 = acceleration(
						 u + h * (19372.0 / 6561 * w - 25360.0 / 2187 * w2 + 64448.0 / 6561 * w3 - 212.0 / 729 * w4), k2);
		const double w6 = w + h * (9017.0 / 3168 * f1 - 355.0 / 33 * f2 + 46732.0 / 5247 * f3 + 49.0 / 176 * f4 -
									  5103.0 / 18656 * f5),
					 f6 = acceleration(u + h * (9017.0 / 3168 * w - 355.0 / 33 * w2 + 46732.0 / 5247 * w3 + 49.0 / 176 * w4 -
												   5103.0 / 18656 * w5),
						 k2);
		Node next;
		next.s = n.s + h;
		next.u = u + h * (35.0 / 384 * w + 500.0 / 1113 * w3 + 125.0 / 192 * w4 - 2187.0 / 6784 * w5 + 11.0 / 84 * w6);
		next.w = w + h * (35.0 / 384 * f1 + 500.0 / 1113 * f3 + 125.0 / 192 * f4 - 2187.0 / 6784 * f5 + 11.0 / 84 * f6);
		next.a = acceleration(next.u, k2);
		// The difference of the orders, as a change of the velocity's two parts, b u and max(b, 1) w, over its size.
		const double du = h * (71.0 / 57600 * w - 71.0 / 16695 * w3 + 71.0 / 1920 * w4 - 17253.0 / 339200 * w5 + 22.0 / 525 * w6 -
								  1.0 / 40 * next.w);
		const double dw = h * (71.0 / 57600 * f1 - 71.0 / 16695 * f3 + 71.0 / 1920 * f4 - 17253.0 / 339200 * f5 +
								  22.0 / 525 * f6 - 1.0 / 40 * next.a);
		const double error = std::sqrt((plan.b2 * du * du + std::max(plan.b2, 1.0) * dw * dw) / (1 + plan.b2 * u * u * u));
		const double factor = error > 0 ? 0.9 * std::pow(allowed / error, 0.2) : 5;
		if (error <= allowed || tries == 30) {
			plan.next = h * std::clamp(factor, 0.2, 5.0);
			return next;
		}
		h *= std::clamp(factor, 0.1, 0.9);
	}
}

} // namespace

const Integrator dopri5 = {start, step};

} // namespace blackhole
