// SPDX-License-Identifier: AGPL-3.0-or-later
/// Cosine and sine of a step's angle, or of a whole path's.
#ifndef BLACKHOLE_TURN_H
#define BLACKHOLE_TURN_H

#include <utility>

namespace blackhole {

/// Of a in radians, to the last digits up to 0.9, to 1e-9 up to 1.8: the series, for a fifth of what the general ones cost.
inline void turn(double a, double& cosine, double& sine) {
	const double q = a * a;
	double s = 1.0 / 6227020800 - q / 1307674368e3, c = -1.0 / 87178291200 + q / 20922789888e3;
	for (const double n : {-1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6, 1.0})
		s = n + q * s;
	for (const double n : {1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24, -0.5, 1.0})
		c = n + q * c;
	sine = a * s;
	cosine = c;
}

/// Of any a >= 0 of some turns, to 1e-15 a.
inline void turn_far(double a, double& cosine, double& sine) {
	const double rounded = a * 0.6366197723675814 + 0.5;
	const int quarters = static_cast<int>(rounded);
	turn(a - quarters * 1.5707963267948966, cosine, sine);
	if (quarters & 1) {
		std::swap(cosine, sine);
		cosine = -cosine;
	}
	if (quarters & 2) {
		cosine = -cosine;
		sine = -sine;
	}
}

} // namespace blackhole

#endif
