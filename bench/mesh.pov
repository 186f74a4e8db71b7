// SPDX-License-Identifier: AGPL-3.0-or-later
// A mesh of 200,000 triangles, a wavy ring round the hole, and a floor: one object that is long to intersect.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -20> look_at 0 angle 50 }
light_source { <20, 30, -30> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb 0.2] [1 rgb <0.5, 0.7, 1>] } scale 2 translate -1 } }
plane { y, -5 pigment { checker rgb 0.3 rgb 0.9 } }
#declare Around = 500;
#declare About = 200;
#macro Ring(I, J)
	#local A = 2 * pi * I / Around;
	#local B = 2 * pi * J / About;
	#local R = 5.5 + (1 + 0.15 * sin(12 * A) * sin(5 * B)) * cos(B);
	<R * cos(A), (1 + 0.15 * sin(12 * A) * sin(5 * B)) * sin(B), R * sin(A)>
#end
mesh2 {
	vertex_vectors {
		Around * About
		#for (I, 0, Around - 1) #for (J, 0, About - 1), Ring(I, J) #end #end
	}
	face_indices {
		2 * Around * About
		#for (I, 0, Around - 1)
			#for (J, 0, About - 1)
				#local P = I * About + J;
				#local Q = mod(I + 1, Around) * About + J;
				#local K = I * About + mod(J + 1, About);
				#local L = mod(I + 1, Around) * About + mod(J + 1, About);
				, <P, Q, K>, <Q, L, K>
			#end
		#end
	}
	pigment { rgb <0.8, 0.5, 0.3> }
	finish { reflection 0.2 }
}
blackhole { 0, 1 effect_radius 12 tolerance Tol }
