// First light: a black hole in front of a painted sky.
// SPDX-License-Identifier: AGPL-3.0-or-later
//   ./render scenes/first_light.pov
//   ./render scenes/first_light.pov Blackhole=off        the same scene without the hole
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "functions.inc"

#ifndef (Tol) #declare Tol = 1e-3; #end

camera { location <0, 2, -22> look_at <0, 0, 0> angle 50 }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol }
#end

// A sky one can find one's way in: a grid of 15 degrees, a band of stars' glow, a colour for each side.
sky_sphere {
  pigment {
    gradient y
    color_map { [0.0 rgb <0.02, 0.03, 0.08>] [0.5 rgb <0.10, 0.16, 0.35>] [1.0 rgb <0.02, 0.03, 0.08>] }
    scale 2 translate -1
  }
  pigment {
    function { pow(max(0, 1 - 4*abs(0.8*y + 0.6*x)), 2) * (0.5 + 0.5*f_noise3d(9*x, 9*y, 9*z)) }
    color_map { [0 rgbt <1, 0.8, 0.6, 1>] [1 rgbt <1, 0.85, 0.7, 0.1>] }
  }
}
