// SPDX-License-Identifier: AGPL-3.0-or-later
// Every kind of light: spot, cylinder, area, parallel, looks_like, shadowless, fading, groups, projected.
#include "world.inc"
View(<0, 3, -14>, 0, 50) Hole(0) Sky() Floor()
light_source { <-6, 8, -3> rgb <1, 0.3, 0.2> spotlight point_at <-4, -3, 1> radius 9 falloff 14 Put() }
light_source { <6, 8, -3> rgb <0.2, 1, 0.3> cylinder point_at <4, -3, 1> radius 1.2 falloff 1.6 Put() }
light_source { <0, 9, -5> rgb 0.4 area_light 2*x, 2*z, 3, 3 Put() }
light_source { <5, 9, -9> rgb <0.2, 0.2, 0.3> parallel point_at 0 shadowless Put() }
light_source { <3.5, 0.6, -2> rgb <0.8, 0.8, 0.3> looks_like { sphere { 0, 0.3 pigment { rgb <1, 1, 0.6> } finish { Glow } } } fade_distance 2*Size fade_power 2 Put() }
light_group { light_source { <-3, 5, -2> rgb <1, 0, 1> } sphere { <-3.2, 0, 3>, 1 pigment { rgb 1 } finish { Matt } } global_lights off Put() }
sphere { <3, 1, 4>, 1.2 pigment { rgb 1 } finish { Matt phong 0.7 } Put() }
