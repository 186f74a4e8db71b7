// SPDX-License-Identifier: AGPL-3.0-or-later
// Whole surface: a globe round the hole, seen from 500 Schwarzschild radii. "From any point outside one sees all of its surface", it
// was said in 1999. Corrected: of a small globe only. Light that grazes a globe of radius 1.7603 has gone just half round it when it
// comes from far away; from 500 radii the limit is 1.7586. Below it the far pole, red, is drawn out to a ring at the rim; above it the
// pole hides: of a globe of 1.70 one sees to 192.0 degrees from the middle, of one of 1.85 to 166.6, and a red cap of 12 stays unseen.
//   ./render scenes/whole_surface.pov +A0.1                       radius 1.70: all of it
//   ./render scenes/whole_surface.pov +A0.1 Declare=Radius=1.85   not all
//   ./render scenes/whole_surface.pov +A0.1 Blackhole=off         one half
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Radius) #declare Radius = 1.70; #end

camera { location <0, 0, -500> up y right x*image_width/image_height angle 1.05 look_at <0, 0, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol }
#end

// The globe: fields of 15 degrees; the half towards the camera blue, the half behind it golden, the far pole red.
#declare From_Near_Pole = function (z) { degrees(acos(max(-1, min(1, -z)))) }
#declare Field = function (x, y, a) { mod(floor(a/15) + floor(degrees(atan2(y, x))/15 + 24), 2) }
#macro Fields (Dark, Light)
  function { Field(x, y, From_Near_Pole(z)) } color_map { [0.5 rgb Dark] [0.5 rgb Light] }
#end
sphere {
  <0, 0, 0>, 1
  pigment {
    function { From_Near_Pole(z)/180 }
    pigment_map {
      [0.5 Fields(<0.015, 0.07, 0.22>, <0.10, 0.30, 0.55>)] [0.5 Fields(<0.45, 0.20, 0.03>, <0.95, 0.66, 0.25>)]
      [168/180 Fields(<0.45, 0.20, 0.03>, <0.95, 0.66, 0.25>)] [168/180 rgb <0.9, 0.02, 0.02>]
    }
  }
  finish { emission 1 ambient 0 diffuse 0 }
  scale Radius
}

sky_sphere { pigment { rgb <0.002, 0.003, 0.008> } Blackhole_Stars(1.05, 2, 700, 0.8) }
