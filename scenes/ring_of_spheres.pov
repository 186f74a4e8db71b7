// SPDX-License-Identifier: AGPL-3.0-or-later
// Ring of spheres: twelve round the hole. The one behind it is seen over its top, and a second time below it, thin.
//   ./render scenes/ring_of_spheres.pov
//   ./render scenes/ring_of_spheres.pov Declare=Height=5   from higher up
//   ./render scenes/ring_of_spheres.pov Blackhole=off      the spheres where they stand
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 8 }
#include "functions.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Height) #declare Height = 2.4; #end

camera { location <0, Height, -18> up y right x*image_width/image_height angle 48 look_at <0, 0.1, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  bend_lights off }
#end

light_source { <-40, 50, -20> rgb <1.45, 1.30, 1.08> area_light 10*x, 10*y, 4, 4 adaptive 1 jitter circular orient }
light_source { <40, 20, 30> rgb <0.20, 0.32, 0.60> shadowless }

#macro Hue (H)   // once round the colour wheel as H goes from 0 to 1
  #local A = 2*pi*<H, H - 1/3, H - 2/3>;
  rgb <pow(0.5 + 0.5*cos(A.x), 1.6), 0.75*pow(0.5 + 0.5*cos(A.y), 1.6), pow(0.5 + 0.5*cos(A.z), 1.6)> + 0.02
#end
#for (I, 0, 11)
  sphere {
    <0, 0, 6>, 0.9
    pigment { Hue(I/12) }
    finish { ambient 0 diffuse 0.8 specular 0.7 roughness 0.004 reflection { 0.02, 0.6 fresnel on } conserve_energy }
    interior { ior 1.5 }
    rotate y*30*(I + 0.15)
  }
#end

// The ring they stand on, tiled along and across.
#declare Tile = function (x, y, z) { mod(floor(2*sqrt(x*x + z*z)) + floor(24*(atan2(x, z)/pi + 1) + 0.5), 2) }
disc {
  <0, -0.9, 0>, y, 7.5, 4.5
  pigment { function { Tile(x, y, z) } color_map { [0.5 rgb <0.03, 0.035, 0.045>] [0.5 rgb <0.50, 0.46, 0.40>] } }
  finish { ambient 0 diffuse 0.8 specular 0.3 roughness 0.01 reflection 0.10 }
}

sky_sphere {
  pigment {
    gradient y
    color_map {
      [0 rgb <0.002, 0.003, 0.008>] [0.42 rgb <0.020, 0.022, 0.050>] [0.5 rgb <0.10, 0.075, 0.11>]
      [0.58 rgb <0.020, 0.022, 0.050>] [1 rgb <0.002, 0.003, 0.008>]
    }
    scale 2 translate -y
  }
  pigment {
    crackle form <1, 0, 0>
    color_map { [0 rgbt <90, 95, 100, 0.99>] [0.12 rgbt <0, 0, 0, 1>] }
    scale 1/60
  }
}
