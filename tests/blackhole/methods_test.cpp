// SPDX-License-Identifier: AGPL-3.0-or-later
/// What each method is for: the order of those that step, the exactness of the one that does not. (path_test.cpp has the
/// tolerance's promise for all of them.)
#include "blackhole/chords.h"
#include "blackhole/closed.h"
#include "blackhole/oracle.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace blackhole;

namespace {
constexpr double pi = 3.14159265358979323846;
}

// Halving the step divides the error of a fourth-order method by sixteen. The step is the method's own, so the order is
// read off the number of steps: error ~ steps^-4.
TEST(Rk4, IsOfFourthOrder) {
	const Vec3 x{8, 0, 0}, d{-std::cos(0.5), std::sin(0.5), 0};
	Vec3 direction, position;
	ASSERT_TRUE(oracle::exit_direction(x, d, 100, direction, position));
	double steps[2], error[2];
	int i = 0;
	for (double tolerance : {1e-6, 1e-9}) {
		Path path;
		ASSERT_TRUE(path.solve(x, d, {100, tolerance, Method::rk4}));
		steps[i] = double(path.nodes().size());
		error[i++] = length(cross(direction, path.end_tangent()));
	}
	const double order = std::log(error[0] / error[1]) / std::log(steps[1] / steps[0]);
	EXPECT_GT(order, 3.7);
	EXPECT_LT(order, 4.6);
}

// With the error control out of the way (a tolerance that allows all, the step given each time).
TEST(Dopri5, IsOfFifthOrder) {
	const Vec3 x{8, 0, 0}, d{-std::cos(0.5), std::sin(0.5), 0};
	const Orbit orbit(x, d);
	const double end = 2; // past the turning point
	const Exact_Orbit::State exact = Exact_Orbit(x, d).at(end);
	double last = 0;
	for (int steps : {8, 16, 32, 64}) {
		Plan plan = dopri5.start(orbit, 1e9);
		Node n{0, orbit.u, orbit.w, acceleration(orbit.u, plan.k2)};
		for (int i = 0; i < steps; i++) {
			plan.next = end / steps;
			n = dopri5.step(n, plan);
		}
		ASSERT_NEAR(n.s, end, 1e-12);
		const double error = std::fabs(n.u - exact.u) + std::fabs(n.w - exact.du);
		if (last > 0) {
			EXPECT_GT(std::log2(last / error), 4.6) << steps;
			EXPECT_LT(std::log2(last / error), 6) << steps;
		}
		last = error;
	}
	EXPECT_LT(last, 1e-8);
}
// However coarse its chords are, their ends lie on the path.
TEST(Exact, ChordsEndOnThePathAndItsDirectionIsExact) {
	for (double r0 : {999.0, 25.0, 3.0, 1.6, 1.2})
		for (int i = 1; i < 40; i++) {
			const double a =
				pi * (1 - i * (r0 > 50 ? 2.5 / r0 : 1) / 41); // never just tangential, where the oracle is good to 1e-9
			const oracle::Ray exact(r0, a);
			if (std::fabs(double(exact.b()) / critical_b - 1) < 1e-3)
				continue;
			Path path;
			ASSERT_TRUE(path.solve({r0, 0, 0}, {std::cos(a), std::sin(a), 0}, {1000, 1e-2, Method::exact}));
			Chords chords(path, 1e-2, false);
			Chord c;
			while (chords.next(c)) {
				double phi = std::atan2(c.to.y, c.to.x);
				while (phi < 0)
					phi += 2 * pi;
				const double r = length(c.to);
				if (path.swept() < 2 * pi && r > 1 + 1e-9 && r < 999) {
					EXPECT_LT(double(exact.distance(r, phi)) / r, 1e-10) << r0 << " " << a;
				}
			}
			Vec3 direction, position;
			if (oracle::exit_direction({r0, 0, 0}, {std::cos(a), std::sin(a), 0}, 1000, direction, position)) {
				EXPECT_LT(length(direction - path.end_tangent()), 1e-10) << r0 << " " << a;
			}
		}
}
