// SPDX-License-Identifier: AGPL-3.0-or-later
// The camera and the skies compare.py shows to both programs. Rs = 1; GYOTO's axes x, y, z are POV-Ray's -z, x, y.
//   Declare=Painted=0  the sky's colour is its direction, (c + 1)/2 * 0.998 + 0.001 for each component c
//   Declare=Painted=1  a chequer of 15 degrees of azimuth and elevation, and a white disc exactly behind the hole
//   Declare=Effect=0   no hole; else its effect radius
//   Declare=Chords=1   a speck that nobody sees, so that there is something to test chords against
#version 3.7;
global_settings { assumed_gamma 1.0 }

#declare Out = <sin(Theta)*sin(Phi), cos(Theta), -sin(Theta)*cos(Phi)>; // e_r
#declare Up = <cos(Theta)*sin(Phi), -sin(Theta), -cos(Theta)*cos(Phi)>*-1; // -e_theta
#declare Right = <cos(Phi), 0, sin(Phi)>; // e_phi
camera {
  location Distance*Out
  direction -Out + (Window_Left + Window_Right)/2*Right + (Window_Bottom + Window_Top)/2*Up
  right (Window_Right - Window_Left)*Right
  up (Window_Top - Window_Bottom)*Up
}

#if (Effect > 0)
blackhole { <0, 0, 0>, 1 effect_radius Effect tolerance 1e-4 }
#end
#if (Chords)
sphere { 100*Out, 1e-6 pigment { rgb 0 } }
#end

#declare Bx = -Out.x; #declare By = -Out.y; #declare Bz = -Out.z;
#declare Cell = function(x, y, z) { mod(floor(atan2(x, z)*12/pi) + floor(asin(min(1, max(-1, y)))*12/pi) + 48, 2) }
#declare Disc = function(x, y, z) { select(x*Bx + y*By + z*Bz - cos(radians(3)), 0, 1) }
#declare Paint = function(c, dark, white) { 0.001 + 0.998*select(white - 0.5, (0.5 + 0.5*c)*(1 - 0.6*dark), 1) }
#declare Code = function(c) { 0.001 + 0.998*(0.5 + 0.5*c) }

sky_sphere {
  pigment {
    average
    pigment_map {
#if (Painted)
      [1 function { Paint(x, Cell(x, y, z), Disc(x, y, z)) } color_map { [0 rgb 0] [1 rgb <3, 0, 0>] }]
      [1 function { Paint(y, Cell(x, y, z), Disc(x, y, z)) } color_map { [0 rgb 0] [1 rgb <0, 3, 0>] }]
      [1 function { Paint(z, Cell(x, y, z), Disc(x, y, z)) } color_map { [0 rgb 0] [1 rgb <0, 0, 3>] }]
#else
      [1 function { Code(x) } color_map { [0 rgb 0] [1 rgb <3, 0, 0>] }]
      [1 function { Code(y) } color_map { [0 rgb 0] [1 rgb <0, 3, 0>] }]
      [1 function { Code(z) } color_map { [0 rgb 0] [1 rgb <0, 0, 3>] }]
#end
    }
  }
}
