// SPDX-License-Identifier: AGPL-3.0-or-later
/// A short smooth piece of a path: the quintic through position, velocity and acceleration of both ends.
///
/// Its error is of sixth order in the step, below that of every method here that makes pieces of it
/// (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, section II.6).
#ifndef BLACKHOLE_PIECE_H
#define BLACKHOLE_PIECE_H

#include "blackhole/vec.h"

namespace blackhole {

/// A point of a path in its plane: position p, velocity v, acceleration a, at affine parameter lambda.
struct Node {
	Vec2 p, v, a;
	double lambda;
};

class Piece {
public:
	Piece(const Node& from, const Node& to) : p0_(from.p) {
		const double h = to.lambda - from.lambda;
		// In t = (lambda - from) / h in [0, 1]; c1, c2 from the start, c3..c5 so that the end fits too.
		c1_ = h * from.v;
		c2_ = (0.5 * h * h) * from.a;
		const Vec2 dp = to.p - p0_ - c1_ - c2_;
		const Vec2 dv = h * to.v - c1_ - 2.0 * c2_;
		const Vec2 da = (h * h) * to.a - 2.0 * c2_;
		c3_ = 10.0 * dp - 4.0 * dv + 0.5 * da;
		c4_ = -15.0 * dp + 7.0 * dv - da;
		c5_ = 6.0 * dp - 3.0 * dv + 0.5 * da;
	}

	/// Position at t in [0, 1].
	Vec2 at(double t) const { return p0_ + t * (c1_ + t * (c2_ + t * (c3_ + t * (c4_ + t * c5_)))); }
	/// Derivative of at() by t: the tangent, of no particular length.
	Vec2 tangent(double t) const { return c1_ + t * (2.0 * c2_ + t * (3.0 * c3_ + t * (4.0 * c4_ + t * (5.0 * c5_)))); }

private:
	Vec2 p0_, c1_, c2_, c3_, c4_, c5_;
};

} // namespace blackhole

#endif
