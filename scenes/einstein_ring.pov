// SPDX-License-Identifier: AGPL-3.0-or-later
// Einstein ring: camera, hole and a galaxy in one line. The galaxy is seen on every side of the hole, its core drawn out to a circle.
//   ./render scenes/einstein_ring.pov
//   ./render scenes/einstein_ring.pov Declare=Off=4   the galaxy four out of line: the circle parts into two arcs
//   ./render scenes/einstein_ring.pov Blackhole=off   the galaxy as it is
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 20 }
#include "functions.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Off) #declare Off = 0; #end

camera { location <0, 0, -25> up y right x*image_width/image_height angle 62 look_at <0, 0, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol }
#end

// A galaxy: a disc of radius 1 whose light adds to what lies behind it (a hundredfold colour at one per cent opacity).
#declare Clump = function (x, y, z) { f_noise3d(9*x, 9*y, z) + f_noise3d(23*x, 23*y, z)/2 + f_noise3d(53*x, 53*y, z)/3 - 0.92 }
#declare Spiral = function (x, y, z, r) {
  1.9*exp(-3.4*r)*(1 - r)*(1 - exp(-30*r*r))*max(0.05, 1 + 1.8*Clump(x, y, 5))*
  (0.16 + pow(0.5 + 0.5*cos(2*atan2(y, x) + 5.2*ln(r + 0.02) + 1.3*Clump(x, y, 1)), 2))
}
#declare Arms = function (x, y, z) { min(0.999, max(0, Spiral(x, y, z, f_r(x, y, z)))) }
#default { finish { emission 1 ambient 0 diffuse 0 } }
#declare Galaxy = disc {
  <0, 0, 0>, z, 1
  texture { pigment {
    function { Arms(x, y, z) }
    color_map {
      [0.02 rgbt <0, 0, 0, 1>] [0.12 rgbt <5, 9, 26, 0.99>] [0.4 rgbt <38, 62, 130, 0.99>] [0.8 rgbt <120, 160, 230, 0.99>]
    }
  } }
  texture { pigment {
    function { Arms(x, y, z)*min(1, max(0, 3*Clump(x, y, 9))) }
    color_map { [0.05 rgbt <0, 0, 0, 1>] [0.5 rgbt <150, 25, 60, 0.99>] }
  } }
  texture { pigment {
    function { exp(-9*f_r(x, y, z)) }
    color_map {
      [0.0 rgbt <0, 0, 0, 1>] [0.1 rgbt <10, 5, 2.5, 0.99>] [0.45 rgbt <75, 38, 15, 0.99>]
      [0.8 rgbt <170, 110, 55, 0.99>] [1 rgbt <260, 220, 160, 0.99>]
    }
  } }
}
object { Galaxy scale 12 rotate <42, 0, 20> translate <Off, 0, 30> no_shadow }

// A few faint stars.
#macro Stars (Cells, Radius, Power)   // cells to a radian; the largest star's radius, in radians
  pigment {
    crackle form <1, 0, 0>
    color_map { [0 rgbt <75*Power, 90*Power, 100*Power, 0.99>] [Radius*Cells rgbt <0, 0, 0, 1>] }
    scale 1/Cells
  }
#end
sky_sphere {
  pigment { rgb <0.002, 0.0035, 0.009> }
  Stars(90, 0.0018, 0.5)
  Stars(25, 0.0030, 1.0)
}
