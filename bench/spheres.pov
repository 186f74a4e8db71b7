// SPDX-License-Identifier: AGPL-3.0-or-later
// Fifty mirror balls about the hole and a floor below: many objects close by, many reflections.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -16> look_at 0 angle 55 }
light_source { <20, 30, -30> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb 0.2] [1 rgb <0.5, 0.7, 1>] } scale 2 translate -1 } }
plane { y, -4 pigment { checker rgb 0.3 rgb 0.9 } }
#declare S = seed(1999);
#declare N = 0;
#while (N < 50)
	#declare P = <rand(S) - 0.5, rand(S) - 0.5, rand(S) - 0.5> * 18;
	#declare Q = 0.3 + 0.4 * rand(S);
	#if (vlength(P) > 3.2 + Q & vlength(P) < 9 - Q)
		sphere { P, Q pigment { rgb <rand(S), rand(S), rand(S)> } finish { reflection 0.7 } }
		#declare N = N + 1;
	#end
#end
blackhole { 0, 1 effect_radius 10 tolerance Tol }
