// SPDX-License-Identifier: AGPL-3.0-or-later
// A disc round the hole, balls behind it and a sky: what bench/trade renders whole at several settings.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4.34, -24.62> up y right x*image_width/image_height angle 55 look_at 0 }
light_source { <40, 60, -60> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb 0.1] [0.5 rgb <0.2, 0.3, 0.6>] [1 rgb 0.8] } scale 2 translate -1 } }
disc { 0, y, 10, 3 pigment { checker rgb <1, 0.6, 0.2>, rgb <0.5, 0.1, 0.05> } finish { ambient 1 diffuse 0 } }
#for (I, 0, 7)
	sphere { <2.6*(I - 3.5), 3*sin(2*I), 8 + 3*cos(3*I)>, 1 pigment { rgb <0.3, 0.5, 0.9> } finish { reflection 0.3 specular 0.5 } }
#end
blackhole {
	0, 1
	#ifdef (Reach) effect_radius Reach #end
	#ifdef (Tol) tolerance Tol #end
	#ifdef (Method) #declare Methods = array[3] { "rk4", "dopri5", "exact" } method Methods[Method] #end
}
