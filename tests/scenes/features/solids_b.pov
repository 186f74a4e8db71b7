// SPDX-License-Identifier: AGPL-3.0-or-later
// Prism, surface of revolution, Julia set, sphere sweep, patch, cone, disc, height field.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Lamp(<8, 12, -6>, rgb 1.3)
height_field { function 40, 40 { 0.5 + 0.4*sin(14*x)*sin(11*y) } smooth translate <-0.5, 0, -0.5> scale <14, 1.2, 14> translate <0, -3.5, 2> Checks(<0.6, 0.8, 0.5>, <0.3, 0.4, 0.2>) Put() }
prism { linear_spline 0, 0.8, 6, <0, 1>, <0.9, 0.3>, <0.6, -0.9>, <-0.6, -0.9>, <-0.9, 0.3>, <0, 1> rotate -70*x Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <3.6, 0.6, 2> Put() }
sor { 5, <0.3, -0.6>, <0.6, 0>, <0.9, 0.7>, <0.4, 1.4>, <0.3, 2> pigment { rgb <0.4, 0.7, 1> } finish { Matt } translate <-3.6, 0, 2> Put() }
julia_fractal { <-0.08, 0, -0.83, -0.02> quaternion max_iteration 6 precision 20 pigment { rgb <0.4, 1, 0.4> } finish { Matt } translate <0, 3.2, 3> Put() }
sphere_sweep { b_spline 6, <-1.5, 0, 0>, 0.2, <-1, 1, 0>, 0.3, <0, 0, 1>, 0.3, <1, 1, 0>, 0.2, <1.5, 0, 0>, 0.3, <2, 1, 0>, 0.2 tolerance 1e-5 pigment { rgb <1, 1, 0.4> } finish { Matt } translate <-3, -2.4, 0> Put() }
bicubic_patch { type 1 flatness 0.01 u_steps 3 v_steps 3 #for (I, 0, 3) #for (J, 0, 3) <I*0.7 - 1, J*0.7 - 1, mod(I + J, 2)*0.6> #if (I + J < 6) , #end #end #end pigment { rgb <1, 0.4, 0.8> } finish { Matt } translate <3.4, -1.6, -1> Put() }
cone { <0, -2.6, -3>, 0.7, <0, -1.4, -3>, 0.1 pigment { rgb <0.9, 0.9, 1> } finish { Matt } Put() }
disc { <-1.8, 3.6, 2>, <0.3, 0.4, -1>, 0.9, 0.3 pigment { rgb <1, 0.7, 0.2> } finish { Matt } Put() }
