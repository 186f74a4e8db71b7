// SPDX-License-Identifier: AGPL-3.0-or-later
// Back of one's head: at 1.5 Schwarzschild radii light circles, and who looks along the circle sees his own head from behind.
// "Several times, also away from the horizon line", it was said in 1999. Confirmed, but thin: light that starts 1 mrad above the circle is
// 0.26 radii above it after a turn. So a head of 0.22 radii is 2.5 mrad tall, and e^(2 pi) = 535 times less with each further turn. From
// elsewhere the images lie along the shadow's edge, on all sides: from 3 radii, where the edge is 45 degrees from straight down, a head
// that takes 17 degrees of the circle reaches from 4.6 to 6.2 mrad outside it; from below 1.5 radii they lie inside it, on black.
//   ./render scenes/back_of_head.pov +A0.1                     drawn 400 times as tall as wide
//   ./render scenes/back_of_head.pov +A0.1 Declare=R=3         at 3: two degrees of the shadow's edge, forward, as it is
//   ./render scenes/back_of_head.pov +A0.1 Declare=R=1.3       likewise, from below the circle of light
//   ./render scenes/back_of_head.pov Blackhole=off             nothing: the head is behind the camera
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "blackhole.inc"
#ifndef (Tol) #declare Tol = 1e-4; #end
#ifndef (R) #declare R = 1.5; #end

// The camera on the circle, and a head whose middle is a twenty-fifth of the circle behind it; it grows with R.
#declare Eye = Blackhole_Photon_Circle(1, 0)*R/1.5;
#declare Middle = Blackhole_Photon_Circle(1, -0.04*Blackhole_Photon_Period(1))*R/1.5;
#declare Edge = asin(min(1, 1.5*sqrt(3*(1 - 1/R))/R));
#if (R < 1.5) #declare Edge = pi - Edge; #end            // the shadow's, from straight down
#declare Look = Edge + 0.004*((R > 1.5) - (R < 1.5));
#declare Wide = (R = 1.5 ? 3 : 0.035);
#declare Tall = Wide*image_height/image_width/(R = 1.5 ? 400 : 1);
#declare Ahead = <sin(Look), 0, cos(Look)>;
#declare Up = <cos(Look), 0, -sin(Look)>;
camera { location Eye direction Ahead right Wide*vcross(Up, Ahead) up Tall*Up }

#ifdef (Blackhole_Version)
blackhole { <0, 0, 0>, 1  tolerance Tol  camera "static"  bend_lights off }
#end

light_source { <-30, 20, -40> rgb <1.3, 1.2, 1.05> shadowless }
light_source { <-30, -25, -5> rgb <0.3, 0.4, 0.6> shadowless }

// A head of radius 1: face to +x, crown to +y.
#default { finish { ambient 0.06 diffuse 0.75 } }
#declare Head = union {
  sphere { 0, 1 pigment { rgb <0.85, 0.55, 0.40> } }
  intersection {
    sphere { 0, 1.05 }
    plane { x, 0.05 rotate -z*20 }
    pigment {
      bozo color_map { [0.2 rgb <0.07, 0.02, 0.005>] [0.8 rgb <0.24, 0.09, 0.025>] } turbulence 0.3 scale <0.6, 1.2, 0.06>
    }
  }
  #for (I, -1, 1, 2)
    sphere { 0, 0.25 scale <0.5, 1, 0.6> translate <0.05, -0.05, 1.05*I> pigment { rgb <0.85, 0.5, 0.36> } }
    sphere { <0.93, 0.1, 0.33*I>, 0.12 pigment { rgb 0.03 } }
  #end
  intersection { sphere { 0, 1.12 } plane { -y, -0.3 } pigment { rgb <0.75, 0.03, 0.04> } }
  torus { 1.02, 0.13 translate 0.32*y pigment { rgb 0.9 } }
  sphere { 1.2*y, 0.24 pigment { rgb 0.9 } }
}
object { Head scale 0.21*R/1.5 matrix <1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0> rotate y*360*0.04 translate Middle }

sky_sphere {
  pigment {
    gradient y
    color_map {
      [0.2 rgb <0.01, 0.02, 0.08>] [0.42 rgb <0.03, 0.09, 0.25>] [0.5 rgb <0.12, 0.50, 0.60>]
      [0.58 rgb <0.03, 0.09, 0.25>] [0.8 rgb <0.01, 0.02, 0.08>]
    }
    scale 2 translate -y
  }
}
