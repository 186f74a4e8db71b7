// SPDX-License-Identifier: AGPL-3.0-or-later
// Orbit: once round the hole at R = 8 Schwarzschild radii, in free fall. The film's clock is the traveller's watch; the moons on orbits of
// their own at 4 and 5.5 radii are put where they are at the same moments of the clock far away, by which a turn takes sqrt(16/13) times
// as long. The planet is at rest far off, and passes behind the hole in the middle of the film.
//   ./render scenes/orbit.ini                          the twenty-four frames
//   ./render scenes/orbit.pov Declare=Clock=0.5        one picture
//   ./render scenes/orbit.ini Blackhole=off            the same way without the hole
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 8 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Clock) #declare Clock = clock; #end
#declare R = 8;

#declare Watch = Clock*Blackhole_Orbit_Period(1, R);
#declare Far = Clock*Blackhole_Orbit_Period_Far(1, R);
#declare Eye = vrotate(Blackhole_Orbit(1, R, Watch), x*12);
camera { location Eye up y right x*image_width/image_height angle 80 look_at <0, 0, 0> }

// "static": what somebody at rest sees whom the traveller passes; the aberration of an orbit's speed is not drawn.
#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  camera "static"  bend_lights off }
#end

light_source { <50, 40, 60> rgb <1.5, 1.35, 1.15> shadowless }
light_source { <-60, 10, -30> rgb <0.20, 0.25, 0.40> shadowless }

// Two moons, rough and smooth
sphere { 0, 0.45 translate Blackhole_Orbit_Far(1, 4, Far)
  pigment { rgb <0.75, 0.35, 0.12> } normal { bumps 0.7 scale 0.09 } finish { ambient 0.12 diffuse 0.75 } }
sphere { 0, 0.45 translate -Blackhole_Orbit_Far(1, 5.5, Far)
  pigment { rgb <0.12, 0.42, 0.50> } finish { ambient 0.12 diffuse 0.75 specular 0.5 roughness 0.01 } }

// The planet and its ring, opposite to where the traveller is at half time
union {
  sphere {
    0, 6
    pigment {
      gradient y turbulence 0.06
      color_map {
        [0 rgb <0.55, 0.35, 0.18>] [0.3 rgb <0.85, 0.68, 0.42>] [0.5 rgb <0.60, 0.36, 0.20>]
        [0.8 rgb <0.90, 0.78, 0.55>] [1 rgb <0.55, 0.35, 0.18>]
      }
      scale 3
    }
    finish { ambient 0.02 diffuse 0.8 }
  }
  disc {
    0, y, 13, 8
    pigment {
      function { mod(f_r(x, 0, z), 1.7)/1.7 }
      color_map { [0 rgbt <0.8, 0.7, 0.5, 0.2>] [0.7 rgbt <0.7, 0.55, 0.4, 0.6>] [0.8 rgbt 1] [1 rgbt 1] }
    }
    finish { ambient 0.02 diffuse 0.8 }
  }
  rotate <20, 0, 25> translate vrotate(<2, 2, -45>, x*12)
}

sky_sphere { pigment { rgb <0.003, 0.004, 0.012> } Blackhole_Stars(80, 1.5, 20, 0.9) Blackhole_Stars(80, 3, 5, 1.3) }
