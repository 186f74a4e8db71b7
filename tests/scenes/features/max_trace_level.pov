// SPDX-License-Identifier: AGPL-3.0-or-later
// A bent ray is one level, however many chords it has.
#include "world.inc"
global_settings { max_trace_level 3 }
View(<0, 1, -14>, 0, 45) Hole(<0, 0, 0>) Sky() Lamp(<8, 12, -6>, rgb 1)
box { <-6, -3, 5>, <6, 5, 5.1> pigment { rgb <0.1, 0, 0> } finish { reflection 0.9 ambient 0.3 } Put() }
box { <-6, -3, -16.1>, <6, 5, -16> pigment { rgb <0, 0.1, 0> } finish { reflection 0.9 ambient 0.3 } Put() }
