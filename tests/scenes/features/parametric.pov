// SPDX-License-Identifier: AGPL-3.0-or-later
// A parametric surface, which POV-Ray looks for.
// Straight limit 0.02: parametric surfaces are found to within their accuracy only
// Scale limit 0.05: POV-Ray loses parametric surfaces at 1e-2; the hole shows them several times
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)

parametric { function { cos(u)*(1 + 0.4*cos(v)) } function { 0.4*sin(v) } function { sin(u)*(1 + 0.4*cos(v)) } <0, 0>, <2*pi, 2*pi> contained_by { box { -1.5, 1.5 } } max_gradient 3 accuracy 0.02 precompute 10 x, y, z pigment { rgb <0.4, 1, 0.4> } finish { Matt } rotate -60*x translate <0, 3.2, 3> Put() }
