// SPDX-License-Identifier: AGPL-3.0-or-later
// Debian's benchmark scene with a hole in it.
#include "benchmark.pov"
blackhole { <0, 0.5, 1.2>, 0.1 effect_radius 1.5 tolerance Tol }
