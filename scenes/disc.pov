// SPDX-License-Identifier: AGPL-3.0-or-later
// Disc: a thin disc round the hole from 3 to 9 Schwarzschild radii. Its far half is seen over the hole, the underside of that half
// below it, and the thin bright line at the shadow is the disc once more, by light that went half round.
// Its colours are the scene's own: a real disc would be brighter and bluer where it comes towards us.
//   ./render scenes/disc.pov +A0.1
//   ./render scenes/disc.pov Declare=Height=9     from higher up
//   ./render scenes/disc.pov Blackhole=off        the disc as it is
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 12 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Height) #declare Height = 2.2; #end

camera { location <0, Height, -24> up y right x*image_width/image_height angle 46 look_at <0, 0.5, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol }
#end

object { Blackhole_Disc(<0, 0, 0>, 1, 3, 9, <2.6, 2.0, 1.3>, <0.9, 0.28, 0.06>) rotate <0, 0, -7> }

sky_sphere {
  pigment { rgb <0.002, 0.003, 0.008> }
  Blackhole_Stars(46, 1.5, 30, 0.8)
  Blackhole_Stars(46, 3, 6, 1.5)
}
