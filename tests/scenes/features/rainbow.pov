// SPDX-License-Identifier: AGPL-3.0-or-later
// A rainbow belongs to a direction: each chord has its own.
#include "world.inc"
View(<0, 1, -14>, 0, 55) Hole(0) Sky() Lamp(<8, 12, -6>, rgb 1)
rainbow { direction Along(<0, -0.25, 1>) up Along(y) angle 24 width 7 distance 40*Size jitter 0
  color_map { [0 rgbt <1, 0.3, 1, 0.3>] [0.5 rgbt <0.2, 1, 0.3, 0.2>] [1 rgbt <1, 0.2, 0.1, 0.3>] } }
sphere { <3, -1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
