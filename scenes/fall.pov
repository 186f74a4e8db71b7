// SPDX-License-Identifier: AGPL-3.0-or-later
// Fall: from rest far away through the horizon, looking in, a little past the hole.
//   ./render scenes/fall.ini                           the twenty-four frames
//   ./render scenes/fall.pov Declare=R=1               one picture, at the horizon
//   ./render scenes/fall.ini Blackhole=off             the same way without the hole
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end

// The clock is the falling camera's own watch: from 4 radii to the horizon it takes 4.67 of the time light takes for a radius, and from
// there to the centre another 2/3, the film's last three frames.
#ifndef (R) #declare Eye = Blackhole_Fall(1, 4, 0.15, clock); #declare R = vlength(Eye); #else #declare Eye = -R*z; #end
#if (R < 4) #debug concat("The watch shows ", str(Blackhole_Fall_Time(1, 4, R), 0, 3), " since 4 radii\n") #end

camera {
  ultra_wide_angle
  location Eye up y right x*image_width/image_height angle 150
  look_at Eye + vrotate(z, y*35)
}

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  camera "falling" }
#end

// Four gates of lamps on the way, at rest over the hole; the last is the deepest.
#declare Lamp = array[4] { rgb <1.3, 0.55, 0.12>, rgb <1.2, 0.20, 0.25>, rgb <0.75, 0.25, 1.2>, rgb <0.15, 0.85, 1.1> }
#default { finish { emission 1 ambient 0 diffuse 0 } }
#for (I, 0, 3)
  #for (J, 0, 23)
    sphere { <1.6, 0, 0>, 0.035 pigment { Lamp[I] } rotate z*15*J translate -3.4*pow(0.7, I)*z }
  #end
#end

// The sky: a band of clouds and two sizes of stars.
#declare Octave = function (x, y, z, s) { (2*f_noise3d(s*x + 3*s, s*y + 5*s, s*z + 7*s) - 1)/pow(s, 0.85) }
#declare Noise = function (x, y, z) {
  Octave(x,y,z,1) + Octave(x,y,z,2.1) + Octave(x,y,z,4.3) + Octave(x,y,z,8.7) + Octave(x,y,z,17.9)
}
#declare Clouds = function (x, y, z) {
  exp(-pow((y + 0.07*Noise(3*x, 3*y + 9, 3*z))/0.14, 2))*(0.38 + 0.1*z)*max(0.1, 1 + 0.9*Noise(6*x + 4, 9*y, 6*z))
}
#macro Stars (Cells, Radius, Power)   // cells to a radian; the largest star's radius, in radians
  pigment {
    crackle form <1, 0, 0>
    color_map { [0 rgbt <80*Power, 90*Power, 100*Power, 0.99>] [Radius*Cells rgbt <0, 0, 0, 1>] }
    scale 1/Cells
  }
#end
sky_sphere {
  pigment {
    function { min(0.999, Clouds(x, y, z)) }
    color_map {
      [0.00 rgb <0.002, 0.004, 0.012>] [0.16 rgb <0.030, 0.031, 0.070>] [0.30 rgb <0.13, 0.085, 0.115>]
      [0.48 rgb <0.42, 0.24, 0.165>] [0.72 rgb <0.95, 0.66, 0.40>] [1.00 rgb <1.5, 1.35, 1.1>]
    }
  }
  Stars(80, 0.0025, 1.0)
  Stars(25, 0.0050, 2.0)
  rotate <20, 0, 30>
}
