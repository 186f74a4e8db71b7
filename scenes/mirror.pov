// SPDX-License-Identifier: AGPL-3.0-or-later
// Mirror: a looking-glass beside the hole shows it from another side. The gilt arc at the hole's left is the glass once more, seen round the hole.
//   ./render scenes/mirror.pov
//   ./render scenes/mirror.pov Blackhole=off   the same place without the hole
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 8 }
#ifndef (Tol) #declare Tol = 1e-3; #end

camera { location <-6, 3, -17> up y right x*image_width/image_height angle 57 look_at <2, 0, 0> }

#ifdef (Blackhole_Version)
blackhole { <-2, 0.5, 0>, 0.6  tolerance Tol  bend_lights off }
#end

light_source { <-25, 40, -25> rgb <1.5, 1.3, 1.0> area_light 8*x, 8*y, 4, 4 adaptive 1 jitter circular orient }
light_source { <10, 20, 40> rgb <0.20, 0.28, 0.50> shadowless }

#declare Gloss = finish { ambient 0 diffuse 0.8 specular 0.6 roughness 0.005 reflection { 0.02, 0.5 fresnel on } conserve_energy }

// The looking-glass in its gilt frame
union {
  box { <-4.5, -3, 0>, <4.5, 4.0, 0.05> pigment { rgb 0.02 } finish { ambient 0 diffuse 0 reflection 0.92 } }
  difference {
    box { <-4.9, -3, -0.15>, <4.9, 4.4, 0.2> }
    box { <-4.5, -3.1, -0.2>, <4.5, 4.0, 0.1> }
    pigment { rgb <0.95, 0.60, 0.18> }
    finish { ambient 0 diffuse 0.45 specular 0.9 roughness 0.02 metallic reflection { 0.3 metallic } }
  }
  rotate y*40 translate <6.5, 0, 5>
}

sphere { <-4.2, -2.2, -4.0>, 0.8 pigment { rgb <0.75, 0.06, 0.04> } finish { Gloss } interior { ior 1.5 } }
sphere { <-0.2, -2.0, 8>, 1.0 pigment { rgb <0.05, 0.16, 0.75> } finish { Gloss } interior { ior 1.5 } }
sphere { <1.5, -2.2, -4>, 0.8 pigment { rgb <0.80, 0.45, 0.03> } finish { Gloss } interior { ior 1.5 } }

// Columns on a tiled floor
#for (I, 0, 11)
  cylinder {
    <0, -3, 22>, <0, 6, 22>, 0.8 rotate y*(5 + 30*I)
    pigment { rgb <0.80, 0.76, 0.70> } finish { ambient 0.02 diffuse 0.8 }
  }
#end
disc {
  <0, -3, 0>, y, 25
  pigment { checker rgb <0.34, 0.27, 0.21>, rgb <0.045, 0.05, 0.065> scale 2.4 rotate y*20 }
  finish { ambient 0 diffuse 0.8 reflection 0.12 }
}

sky_sphere {
  pigment {
    gradient y
    color_map {
      [0.25 rgb <0.02, 0.02, 0.05>] [0.44 rgb <0.18, 0.12, 0.16>] [0.5 rgb <0.65, 0.34, 0.20>]
      [0.56 rgb <0.25, 0.20, 0.30>] [0.75 rgb <0.03, 0.05, 0.13>] [1 rgb <0.01, 0.015, 0.05>]
    }
    scale 2 translate -y
  }
}
