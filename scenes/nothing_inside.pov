// SPDX-License-Identifier: AGPL-3.0-or-later
// Nothing inside: a row of beads on a rod right through the hole. What lies within the Schwarzschild radius is red: a bead at the
// centre, and the rod's middle. Not one red pixel reaches the picture: of 1999's claims this one is confirmed, and a test counts.
// The nearest beads touch the horizon; what is outside of it is seen, twice and more.
//   ./render scenes/nothing_inside.pov +A0.1
//   ./render scenes/nothing_inside.pov +A0.1 Blackhole=off    with all that the hole hides
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 8 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end

camera { location <-7, 3.5, -14> up y right x*image_width/image_height angle 50 look_at <0, 0, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  bend_lights off }
#end

light_source { <-30, 40, -30> rgb <1.3, 1.2, 1.05> shadowless }
light_source { <30, 5, -10> rgb <0.25, 0.35, 0.6> shadowless }

#declare Gloss = finish { ambient 0.04 diffuse 0.75 specular 0.6 roughness 0.01 }

// Beads every 1.5 radii, blue and ivory; each is painted red where it is inside the horizon.
#macro Painted (Colour)
  pigment {
    function { min(1, f_r(x, y, z)/2) }
    color_map { [0.5 rgb <1, 0, 0>] [0.5 rgb Colour] }
  }
#end
#for (I, -4, 4)
  #local Ivory = mod(abs(I), 2);
  sphere { 1.6*I*x, 0.75 Painted((1 - Ivory)*<0.05, 0.16, 0.55> + Ivory*<0.75, 0.68, 0.55>) finish { Gloss } }
#end
cylinder { -9*x, 9*x, 0.3 Painted(<0.75, 0.50, 0.16>) finish { Gloss } }

sky_sphere { pigment { rgb <0.004, 0.006, 0.02> } Blackhole_Stars(50, 2, 14, 0.9) }
