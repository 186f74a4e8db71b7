// SPDX-License-Identifier: AGPL-3.0-or-later
// Unions, merges, intersections, differences, clips and bounds.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
difference { box { -1.2, 1.2 } sphere { 0, 1.5 } cylinder { -2*y, 2*y, 0.5 } Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <3.4, 0.5, 2> Put() }
merge { sphere { <-3.2, 0, 2>, 1.1 } cylinder { <-3.2, -1, 2>, <-3.2, 2.4, 2>, 0.5 } pigment { rgbt <0.4, 1, 0.6, 0.4> } finish { Matt } Put() }
intersection { sphere { 0, 1.4 } box { <-1.3, -1, -0.8>, <1, 1.1, 2> } cutaway_textures Checks(<0.3, 0.4, 1>, 0.8) translate <0, 3.3, 3> Put() }
sphere { <0, -2, -2>, 0.9 clipped_by { plane { x, 0.3 } } bounded_by { sphere { <0, -2, -2>, 0.95 } } interior_texture { pigment { rgb y } finish { Glow } } texture { pigment { rgb x } finish { Matt } } Put() }
