// SPDX-License-Identifier: AGPL-3.0-or-later
/// A short smooth piece of a path: the quintic through u = 1/r and its first two derivatives at both ends.
///
/// Its error is of sixth order in the step, below that of every method here that makes pieces of it
/// (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, section II.6).
#ifndef BLACKHOLE_PIECE_H
#define BLACKHOLE_PIECE_H

#include <algorithm>
#include <cmath>

namespace blackhole {

/// A point of a path: u = 1/r, w = du/ds and a = d2u/ds2 at the path's parameter s (orbit.h).
struct Node {
	double s, u, w, a;
};

class Piece {
public:
	Piece(const Node& from, const Node& to) : c0_(from.u) {
		const double h = to.s - from.s;
		// In t = (s - from) / h in [0, 1]; c1, c2 from the start, c3..c5 so that the end fits too.
		c1_ = h * from.w;
		c2_ = 0.5 * h * h * from.a;
		const double du = to.u - c0_ - c1_ - c2_;
		const double dw = h * to.w - c1_ - 2.0 * c2_;
		const double da = h * h * to.a - 2.0 * c2_;
		c3_ = 10.0 * du - 4.0 * dw + 0.5 * da;
		c4_ = -15.0 * du + 7.0 * dw - da;
		c5_ = 6.0 * du - 3.0 * dw + 0.5 * da;
	}

	/// u at t in [0, 1].
	double at(double t) const { return c0_ + t * (c1_ + t * (c2_ + t * (c3_ + t * (c4_ + t * c5_)))); }
	/// Its derivative by t.
	double slope(double t) const { return c1_ + t * (2.0 * c2_ + t * (3.0 * c3_ + t * (4.0 * c4_ + t * (5.0 * c5_)))); }

private:
	double c0_, c1_, c2_, c3_, c4_, c5_;
};

/// Where on the piece u is reached, t in [0, 1]: exactly once, since steps are shorter than the path takes to turn round.
/// Newton, kept in a bracket.
inline double crossing(const Piece& piece, double u) {
	const double at0 = piece.at(0), at1 = piece.at(1);
	const bool rising = at1 > at0;
	// From the far end: a ray that grazes the sphere it starts on has a root at its start too.
	double lo = 0, hi = 1, t = 1;
	for (int i = 0; i < 60; i++) {
		const double f = piece.at(t) - u;
		((f > 0) == rising ? hi : lo) = t;
		// No better than the rounding of the piece's own terms.
		if (std::fabs(f) <= 1e-16 * std::max(std::fabs(at0), std::fabs(at1)) || hi - lo < 1e-16)
			break;
		double next = t - f / piece.slope(t);
		if (!(next > lo && next < hi))
			next = (lo + hi) / 2;
		t = next;
	}
	return t;
}

} // namespace blackhole

#endif
