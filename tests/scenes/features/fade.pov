// SPDX-License-Identifier: AGPL-3.0-or-later
// Glass that takes colour by the length of the way in it: both laws of interior fading.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky()
sphere { 0, 4 pigment { rgbt 1 } finish { ambient 0 diffuse 0 } hollow
  interior { ior 1 fade_distance 3*Size fade_power 1001 fade_color <0.9, 0.5, 0.3> } Put() }
box { -1, 1 translate <0, 5.3, 0> pigment { rgbt 1 } finish { ambient 0 diffuse 0 }
  interior { ior 1.2 fade_distance 2*Size fade_power 2 fade_color <0.2, 0.5, 0.9> } Put() }
