// SPDX-License-Identifier: AGPL-3.0-or-later
// A mesh camera that sees no farther than a distance along the ray.
#include "world.inc"
#declare Grid = mesh { #for (J, 0, 47) #for (I, 0, 63) #local X = (I + 0.5)/64 - 0.5; #local Y = 0.5 - (J + 0.5)/48;
  triangle { <X*12, Y*9 + 1, -12> + <-0.02, -0.02, 0>, <X*12, Y*9 + 1, -12> + <0, 0.04, 0>, <X*12, Y*9 + 1, -12> + <0.02, -0.02, 0> } #end #end Put() };
camera { mesh_camera { 1 0 15*Size mesh { Grid } } location <0, 0, 0.001> direction z }
Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
sphere { <3, 1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
