// SPDX-License-Identifier: AGPL-3.0-or-later
// Table: its top and its underside at once. It stands behind the hole, a little below the camera's height, so that without the hole
// one sees the green top only. Light that passes over the hole shows the top, light that passes below it the red underside: as it was
// said in 1999, confirmed.
//   ./render scenes/table.pov +A0.1
//   ./render scenes/table.pov +A0.1 Blackhole=off    the top only
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 8 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end

camera { location <0, 1.2, -22> up y right x*image_width/image_height angle 52 look_at <0, 0, 0> }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  bend_lights off }
#end

light_source { <-30, 45, -25> rgb <1.2, 1.1, 0.95> area_light 8*x, 8*y, 4, 4 adaptive 1 jitter circular orient }
light_source { <15, -40, -35> rgb <0.75, 0.7, 0.65> shadowless }

#default { finish { ambient 0.04 diffuse 0.75 } }

// The top in green fields, the underside in red ones, each with a border; a gilt rim between them, and gilt legs.
#macro Fields (Dark, Light)
  pigment {
    function { select(max(abs(x), abs(z)) - 4.2, mod(floor(x/1.4 + 50) + floor(z/1.4 + 50), 2), 0) }
    color_map { [0.5 rgb Dark] [0.5 rgb Light] }
  }
#end
#declare Gilt = texture { pigment { rgb <0.80, 0.52, 0.16> } finish { ambient 0.04 diffuse 0.65 specular 0.6 roughness 0.02 } }
union {
  box { <-5, 0.02, -5>, <5, 0.06, 5> Fields(<0.02, 0.20, 0.05>, <0.16, 0.60, 0.16>) }
  box { <-5, -0.26, -5>, <5, -0.22, 5> Fields(<0.35, 0.02, 0.02>, <0.80, 0.16, 0.08>) }
  box { <-5.02, -0.24, -5.02>, <5.02, 0.04, 5.02> texture { Gilt } }
  #for (I, 0, 3)
    cylinder { <4.6, -4.5, 4.6>, <4.6, 0, 4.6>, 0.22 rotate y*90*I texture { Gilt } }
  #end
  translate <0, 0.1, 9>
}
disc { <0, -4.4, 9>, y, 11 pigment { checker rgb <0.10, 0.11, 0.15>, rgb <0.24, 0.25, 0.31> scale 1.8 rotate y*20 } }

sky_sphere {
  pigment {
    gradient y
    color_map { [0.3 rgb <0.004, 0.006, 0.02>] [0.5 rgb <0.02, 0.03, 0.08>] [0.7 rgb <0.004, 0.006, 0.02>] }
    scale 2 translate -y
  }
  Blackhole_Stars(52, 2, 12, 0.9)
}
