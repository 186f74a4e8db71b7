// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/route.h"

#include <algorithm>
#include <cstdlib>

namespace blackhole {
namespace {

// The cosine of what a piece may sweep for lens(): 1.16 radians.
constexpr float widest_lens = 0.4F;

// What single precision may lose of a radius, several times over.
constexpr float rounding = 1e-6F;

// Corners of four pieces, or their ends: u, b du/dphi as a Knot's, cosine and sine; then the points, and tangents of some length.
struct Corners {
	Four u, v, c, s, r, x, y, tx, ty;

	Corners(const Four* rows, double b) {
		transpose(rows, u, v, c, s);
		// One step of Newton's, as for a single corner.
		const Four even = 1.5F - 0.5F * (c * c + s * s), across = static_cast<float>(b) * u;
		c *= even;
		s *= even;
		r = 1.0F / u;
		x = r * c;
		y = r * s;
		tx = -v * c - across * s;
		ty = across * c - v * s;
	}
};

// How steep the tangent is against the long chord.
Four steepness(const Corners& at, Four dx, Four dy) {
	const Four steep = all(100), p = absolute(at.tx * dy - at.ty * dx) / (at.tx * dx + at.ty * dy);
	return p >= 0 ? lesser(p, steep) : steep;
}

// How far a piece is from its long chord at most, as a part of that chord's distance from the centre; swept: the cosine of its
// angle. On the chord u'' + u = 0, on the piece (3/2) u^2. Were both ends' u joined by a straight line y and were the angle
// small, the difference d would have d'' = -(3/2) y^2, so d = (3/2) t (1 - t) of a mean of y^2, in which the greater end counts
// no more than thrice; d / y^2 is the distance along the radius, d / y that from the chord, for a chord at distance 1. t (1 - t)
// / y is at most 1 over the square of the sum of the ends' roots. The tangent of half the angle for half the angle, and 4 %, make
// up for wide pieces (tests/blackhole/pieces_test.cpp).
Four lens(Four u0, Four u1, Four swept) {
	const Four sum = u0 + u1, product = u0 * u1, least = lesser(u0, u1), most = greater(u0, u1);
	return 0.52F * (1 - swept) * (least * least + 2 * product + 3 * most * most) * sum /
		   ((1 + swept) * (sum * sum + 4 * product));
}

} // namespace

// As a charted knot: before the turning point, or on the way in, mirrored.
[[gnu::always_inline]] inline Knot Route::row(int number) const {
	if (number > ramps_ && number < corners_) {
		const int q = first_ + number - ramps_ - 1;
		return q < 0 ? Knot{1, -1, 1, -1} * orbit_.knot(-q) : orbit_.knot(q);
	}
	const State& at = number == 0 ? begin_ : (number == corners_ ? end_ : ramp_[number - 1]);
	return Knot{static_cast<float>(at.u), static_cast<float>(std::max(orbit_.b(), 1.0) * at.w), static_cast<float>(at.cosine),
		static_cast<float>(at.sine)};
}

int Route::pieces(int first, int last, int chords, Pieces& out) const {
	Knot rows[5];
	rows[0] = row(first);
	int count = 0, at = first;
	while (count < 4 && at < last) {
		at = std::min(at + chords, last);
		rows[++count] = row(at);
	}
	for (int i = count; i < 4; i++)
		rows[i + 1] = rows[count];
	const Corners from(rows, orbit_.b()), to(rows + 1, orbit_.b());
	out.x = from.x;
	out.y = from.y;
	const Four dx = to.x - from.x, dy = to.y - from.y, l = root(dx * dx + dy * dy), far = greater(from.r, to.r);
	const Four swept = from.c * to.c + from.s * to.s;
	out.dx = dx;
	out.dy = dy;
	Four bulge = all(0);
	out.length = l;
	if (chords > 1) {
		const Four some = greater(l, all(1e-30));
		bulge = lens(from.u, to.u, swept) * absolute(from.x * dy - from.y * dx) / some;
		if (not_greater(swept, all(widest_lens)) != 0) {
			// The triangle of the long chord and the tangents at its ends.
			const Four p = steepness(from, dx, dy), q = steepness(to, dx, dy), triangle = l * p * q / greater(p + q, all(1e-30));
			bulge = swept > widest_lens ? bulge : triangle;
		}
		out.length = l + 1.6F * bulge * bulge / some;
		bulge += static_cast<float>(0.1 * tolerance_) * far;
	}
	out.bulge = bulge + rounding * far;
	out.farthest = far + out.bulge;
	// More than half a turn may come as near as it likes.
	const Four whole = from.c * to.s - from.s * to.c, none = all(0);
	out.nearest = greater(whole, swept) < 0 ? none : 0.5F * (1 + swept) * lesser(from.r, to.r) - rounding * far;
	return count;
}

} // namespace blackhole
