// SPDX-License-Identifier: AGPL-3.0-or-later
// Debian's chess board with a hole over it: infinite and large CSG objects are what chords meet.
#include "chess2.pov"
blackhole { <6, 7, -6>, 1 effect_radius 12 tolerance Tol }
