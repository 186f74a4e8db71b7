// SPDX-License-Identifier: AGPL-3.0-or-later
// First light: a black hole before a painted sky. The Milky Way runs behind the hole, and is seen round it on every side.
//   ./render scenes/first_light.pov                  the picture
//   ./render scenes/first_light.pov Declare=Grid=1   with lines every 15 degrees on the sky
//   ./render scenes/first_light.pov Blackhole=off    the same sky without the hole
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "functions.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end

camera { location <0, 0, -22> up y right x*image_width/image_height angle 76 look_at <1.6, -0.3, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol }
#end

// Noise in six octaves.
#declare Octave = function (x, y, z, s) { (2*f_noise3d(s*x + 3*s, s*y + 5*s, s*z + 7*s) - 1)/pow(s, 0.85) }
#declare Noise = function (x, y, z) {
  Octave(x,y,z,1) + Octave(x,y,z,2.1) + Octave(x,y,z,4.3) + Octave(x,y,z,8.7) + Octave(x,y,z,17.9) + Octave(x,y,z,36.1)
}// The band lies along y = 0 and is brightest at +z. Clouds of stars, and dust before them, both frayed.
#declare Lane = function (x, y, z) { exp(-pow((y + 0.012 + 0.09*Noise(4*x, 4*y, 4*z))/0.042, 2)) }
#declare Dust = function (x, y, z) { Lane(x, y, z)*(0.75 + Noise(8*x, 11*y, 8*z)) }
#declare Clouds = function (x, y, z) {
  (exp(-pow((y + 0.05*Noise(3*x, 3*y + 9, 3*z))/0.105, 2))*(0.30 + 0.17*z) + 0.40*pow(max(0, z), 12)*exp(-pow(y/0.13, 2)))
  *max(0.1, 1 + 0.7*Noise(7*x + 4, 10*y, 7*z))
}
// Stars: where the sphere of directions cuts small balls strewn in space, so that few are large and many small.
// A hundredfold colour at one per cent opacity is light that adds to what lies behind it.
#macro Stars (Cells, Radius, Power)   // cells to a radian; the largest star's radius, in radians
  #local P = 100*Power;
  pigment {
    crackle form <1, 0, 0>
    pigment_map {
      [0 crackle form <1, 0, 0> solid color_map {
        [0.0 rgbt <0.30*P, 0.50*P, P, 0.99>] [0.4 rgbt <0.75*P, 0.85*P, P, 0.99>]
        [0.7 rgbt <P, 0.85*P, 0.60*P, 0.99>] [1.0 rgbt <P, 0.40*P, 0.15*P, 0.99>] }]
      [Radius*Cells color rgbt <0, 0, 0, 1>]
    }
    scale 1/Cells
  }
#end

sky_sphere {
  pigment {
    function { min(0.999, Clouds(x, y, z)*(1 - 0.9*min(1, max(0, Dust(x, y, z))))) }
    color_map {
      [0.00 rgb <0.0015, 0.0025, 0.0080>] [0.06 rgb <0.006, 0.010, 0.026>] [0.16 rgb <0.030, 0.031, 0.070>]
      [0.30 rgb <0.13, 0.085, 0.115>] [0.48 rgb <0.42, 0.24, 0.165>] [0.72 rgb <0.95, 0.66, 0.40>] [1.00 rgb <1.5, 1.35, 1.1>]
    }
  }
  Stars(170, 0.0014, 0.5) Stars(60, 0.0024, 1.5) Stars(16, 0.0046, 3.0)
  #ifdef (Grid)
    pigment {
      function { min(1, min(abs(sin(12*asin(y))), abs(sin(12*atan2(x, z)))*sqrt(x*x + z*z))/0.03) }
      color_map { [0.5 rgb <0.06, 0.38, 0.45>] [1 rgbt <0.06, 0.38, 0.45, 1>] }
    }
  #end
  rotate <6, 9, 27>
}
