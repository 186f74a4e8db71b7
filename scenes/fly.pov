// SPDX-License-Identifier: AGPL-3.0-or-later
// Fly: a flight through a hall with a hole in the middle. The hall is at rest and so is the camera in each picture: the film goes from one
// observer at rest to the next, and nothing of the speed is seen.
//   ./render scenes/fly.ini                      the twenty-four frames
//   ./render scenes/fly.pov Declare=Clock=0.5    one picture, nearest to the hole
//   ./render scenes/fly.ini Blackhole=off        the hall without the hole
#version 3.7;
global_settings { assumed_gamma 1.0  max_trace_level 8 }
#ifndef (Tol) #declare Tol = 1e-3; #end
#ifndef (Clock) #declare Clock = clock; #end

// Between two pillars, a third of a turn round the hole, and out again: from 11 Schwarzschild radii to 6 and back to 11.
#declare R = 11 - 5*pow(sin(pi*Clock), 2);
#declare Turn = 60 - 120*Clock;
camera {
  location vrotate(<0, 0.4, -R>, y*Turn)
  up y right x*image_width/image_height angle 85 look_at vrotate(<-1.2, 0.2, 0>, y*Turn)
}

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  camera "static"  bend_lights off }
#end

#default { finish { ambient 0.03 diffuse 0.75 } }
light_source { <-9, 6.4, -7> rgb <1.1, 0.85, 0.6> fade_distance 12 fade_power 2 }
light_source { <10, 6.4, 8> rgb <0.6, 0.8, 1.15> fade_distance 12 fade_power 2 }
light_source { <0, 6, 0> rgb 0.35 shadowless }

// Floor and ceiling, four walls of different colours, each with a frieze.
#macro Wall (Turn, Colour)
  #local Bricks = pigment { brick rgb 0.45*Colour, rgb Colour brick_size <2.8, 1.1, 3> mortar 0.08 }
  box {
    <-14, -4, 14>, <14, 7, 14.5>
    pigment {
      gradient y
      pigment_map {
        [0.04 rgb 0.08] [0.04 Bricks scale 1/11] [0.86 Bricks scale 1/11]
        [0.86 checker rgb <0.80, 0.60, 0.20>, rgb 0.05 scale 0.7/11]
      }
      scale 11 translate -4*y
    }
    rotate y*Turn
  }
#end
Wall(0, <0.45, 0.08, 0.05>) Wall(90, <0.05, 0.14, 0.38>) Wall(180, <0.50, 0.33, 0.08>) Wall(270, <0.06, 0.26, 0.10>)
box {
  <-14, -4.5, -14>, <14, -4, 14>
  pigment { checker rgb <0.62, 0.58, 0.50>, rgb <0.07, 0.07, 0.09> scale 2 } finish { reflection 0.08 }
}
box { <-14, 7, -14>, <14, 7.5, 14> pigment { checker rgb <0.42, 0.33, 0.24>, rgb <0.30, 0.22, 0.15> scale 2 } }

// Twelve pillars
#for (I, 0, 11)
  union {
    cylinder { <0, -4, 8>, <0, 7, 8>, 0.45 }
    box { <-0.7, -4, 7.3>, <0.7, -3.5, 8.7> }
    box { <-0.7, 6.5, 7.3>, <0.7, 7, 8.7> }
    rotate y*(15 + 30*I)
    pigment { rgb <0.65, 0.58, 0.47> } finish { specular 0.3 roughness 0.03 }
  }
#end
