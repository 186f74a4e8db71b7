// SPDX-License-Identifier: AGPL-3.0-or-later
// Blob, torus, superellipsoid, text, lathe: shapes that drop hits near a ray's start, grown so that it matters.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
blob { threshold 0.6 sphere { <-0.07, 0, 0>, 0.12, 1 } sphere { <0.07, 0, 0>, 0.12, 1 } cylinder { -0.1*y, 0.1*y, 0.09, 1 } scale 14 Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <3.6, 0.6, 2> Put() }
torus { 0.1, 0.035 rotate 60*x scale 12 pigment { rgb <0.4, 0.7, 1> } finish { Matt } translate <-3.6, 1.4, 2> Put() }
superellipsoid { <0.3, 0.6> scale 0.9 pigment { rgb <0.4, 1, 0.4> } finish { Matt } rotate <20, 30, 0> translate <0, 3.3, 3> Put() }
text { ttf "timrom.ttf" "Rs" 0.4, 0 scale 1.6 pigment { rgb <1, 1, 0.4> } finish { Matt } translate <-4.6, -2.6, 1> Put() }
lathe { cubic_spline 5, <0.2, -1.5>, <0.5, -1>, <0.9, 0>, <0.3, 1>, <0.1, 1.6> pigment { rgb <1, 0.4, 0.8> } finish { Matt } translate <2.6, -2, -1> Put() }
