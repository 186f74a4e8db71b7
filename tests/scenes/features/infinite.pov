// SPDX-License-Identifier: AGPL-3.0-or-later
// Planes, quadrics and higher surfaces without end.
#include "world.inc"
View(<0, 2, -14>, 0, 50) Hole(0) Sky() plane { y, -3.1 Checks(<0.7, 0.65, 0.5>, <0.15, 0.2, 0.3>) Put() } Lamp(<8, 12, -6>, rgb 1.3)
plane { z, 25 hollow Checks(<0.6, 0.3, 0.3>, <0.3, 0.3, 0.6>) Put() }
quadric { <1, -0.4, 1>, <0, 0, 0>, <0, 0, 0>, -1.2 Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <5, 1, 8> Put() }
cubic { <1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, -0.3, 0, 1, 0, 0, -0.5> clipped_by { sphere { 0, 2.2 } } pigment { rgb <0.4, 0.7, 1> } finish { Matt } translate <-4.2, 0.5, 3> Put() }
poly { 4, <1,0,0,0,2,0,0,2,0,-3,0,0,0,0,0,0,0,0,0,0,1,0,0,2,0,1.5,0,0,0,0,1,0,-3,0,2> scale 0.5 pigment { rgb <0.4, 1, 0.4> } finish { Matt } translate <0, 3.4, 3> Put() }
