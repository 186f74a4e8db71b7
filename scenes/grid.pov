// SPDX-License-Identifier: AGPL-3.0-or-later
// Grid: the scene's coordinates made visible. Circles at every Schwarzschild radius from 2 to 10, a spoke every 15 degrees, and
// the photon sphere as a globe of wire. The far half of the grid is bent up over the hole; its underside shows below.
//   ./render scenes/grid.pov +A0.1
//   ./render scenes/grid.pov Declare=Height=14    from above: circles stay circles, the inner ones seen larger
//   ./render scenes/grid.pov Blackhole=off        the grid as it lies
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Height) #declare Height = 3; #end

camera { location <0, Height, -18> up y right x*image_width/image_height angle 62 look_at <0, 0.4, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol }
#end

#default { finish { emission 1 ambient 0 diffuse 0 } }
object { Blackhole_Grid(<0, 0, 0>, 1, 10, 1, 24, 0.05) pigment { rgb <0.08, 0.55, 0.75> } }
object { Blackhole_Grid(<0, 0, 0>, 1, 10, 5, 0, 0.1) pigment { rgb <1.0, 0.55, 0.12> } }       // 5 and 10
object { Blackhole_Globe(<0, 0, 0>, 1, 1.5, 30, 0.035) pigment { rgb <0.85, 0.2, 0.55> } }

sky_sphere {
  pigment {
    gradient y
    color_map { [0 rgb <0.002, 0.003, 0.012>] [0.5 rgb <0.012, 0.014, 0.045>] [1 rgb <0.002, 0.003, 0.012>] }
    scale 2 translate -y
  }
  Blackhole_Stars(62, 1.5, 22, 1)
}
