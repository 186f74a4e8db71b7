// SPDX-License-Identifier: AGPL-3.0-or-later
// Isosurfaces and parametric surfaces near joints of chords.
// Straight limit 0.02: parametric surfaces are found to within their accuracy only
// Scale limit 0.05: POV-Ray loses parametric surfaces at 1e-2 and isosurfaces at 1e4; the hole shows them several times
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
isosurface { function { x*x + y*y + z*z - 1 + 0.15*sin(9*x)*sin(9*y) } max_gradient 5 accuracy 0.001*Size contained_by { sphere { 0, 1.4 } } scale 1.3 Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <3.4, 0.5, 2> Put() }
isosurface { function { sqrt(x*x + z*z) - 0.6 - 0.2*cos(4*y) } max_gradient 1.5 accuracy 0.001*Size contained_by { box { -1.5, 1.5 } } open all_intersections pigment { rgb <0.4, 0.7, 1> } finish { Matt } translate <-3.4, 0, 2> Put() }
parametric { function { cos(u)*(1 + 0.4*cos(v)) } function { 0.4*sin(v) } function { sin(u)*(1 + 0.4*cos(v)) } <0, 0>, <2*pi, 2*pi> contained_by { box { -1.5, 1.5 } } max_gradient 3 accuracy 0.02 precompute 10 x, y, z pigment { rgb <0.4, 1, 0.4> } finish { Matt } rotate -60*x translate <0, 3.2, 3> Put() }
