// SPDX-License-Identifier: AGPL-3.0-or-later
// Thin and coincident surfaces: which of two in one place is seen, and that the far side of a sheet is.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
disc { <3.4, 0.5, 2>, -z, 1.5 pigment { rgb <1, 0.5, 0.2> } finish { Matt } Put() }
disc { <3.4, 0.5, 2>, -z, 1.2 pigment { rgb <0.2, 0.5, 1> } finish { Matt } Put() }
box { <-4.8, -1, 2>, <-2.2, 1.6, 2.002> pigment { rgbt <1, 0.9, 0.5, 0.6> } finish { Matt } interior { ior 1.5 } Put() }
sphere { <0, 3.2, 3>, 0.8 pigment { rgbt <0.5, 1, 0.5, 0.5> } finish { Matt } Put() }
sphere { <0, 3.2, 3>, 0.79 pigment { rgb <1, 0.3, 0.6> } finish { Matt } Put() }
polygon { 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> pigment { rgb x } interior_texture { pigment { rgb y } } finish { Matt } rotate 200*y translate <-1.5, -1.8, -2> Put() }
