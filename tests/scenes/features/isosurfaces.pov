// SPDX-License-Identifier: AGPL-3.0-or-later
// Isosurfaces near joints of chords.
// Scale limit 0.05: POV-Ray loses isosurfaces at 1e4; the hole shows them several times
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
isosurface { function { x*x + y*y + z*z - 1 + 0.15*sin(9*x)*sin(9*y) } max_gradient 5 accuracy 0.001*Size contained_by { sphere { 0, 1.4 } } scale 1.3 Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <3.4, 0.5, 2> Put() }
isosurface { function { sqrt(x*x + z*z) - 0.6 - 0.2*cos(4*y) } max_gradient 1.5 accuracy 0.001*Size contained_by { box { -1.5, 1.5 } } open all_intersections pigment { rgb <0.4, 0.7, 1> } finish { Matt } translate <-3.4, 0, 2> Put() }
