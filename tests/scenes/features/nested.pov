// SPDX-License-Identifier: AGPL-3.0-or-later
// Glass in glass, and what is seen through both.
#include "world.inc"
global_settings { max_trace_level 12 }
View(<0, 2, -14>, 0, 45) Hole(<0, -1.2, 0>) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
difference { sphere { <2.2, 2, 1>, 1.6 } sphere { <2.2, 2, 1>, 1.1 } pigment { rgbf <0.8, 0.95, 1, 0.9> } finish { reflection 0.1 } interior { ior 1.4 } Put() }
sphere { <2.2, 2, 1>, 0.6 pigment { rgbft <1, 0.5, 0.5, 0.5, 0.3> } finish { Matt } interior { ior 1.1 } Put() }
sphere { <-2.8, 1.5, 2>, 1.4 pigment { rgbt <1, 1, 0.6, 0.7> } finish { Matt } Put() }
