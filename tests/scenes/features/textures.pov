// SPDX-License-Identifier: AGPL-3.0-or-later
// Layers, uv maps, texture maps, averages, perturbed normals, iridescence, interior textures.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
sphere { 0, 1.4 texture { pigment { rgb <0.8, 0.4, 0.2> } finish { Matt } } texture { pigment { leopard color_map { [0 rgbt 1] [1 rgb <0.1, 0.1, 0.4>] } scale 0.2 } finish { phong 1 } } translate <3.5, 0.4, 2> Put() }
sphere { 0, 1.3 uv_mapping pigment { checker rgb <0.2, 0.9, 0.6> rgb 1 scale <0.1, 0.2, 1> } finish { Matt } translate <-3.5, 0.4, 2> Put() }
sphere { 0, 1.2 texture { gradient y scale 0.7 texture_map { [0.4 pigment { rgb x } finish { Matt }] [0.6 pigment { rgb z } normal { bumps 0.6 scale 0.1 } finish { Matt specular 0.8 }] } } translate <0, 3.2, 3> Put() }
sphere { 0, 0.9 texture { average texture_map { [1 pigment { rgb <1, 1, 0> } finish { Matt }] [2 pigment { granite } normal { dents 0.5 scale 0.2 } finish { Matt irid { 0.4 thickness 0.3 } }] } } translate <-2, -2, -2> Put() }
box { -0.9, 0.9 texture { pigment { rgbt <1, 1, 1, 0.7> } finish { Matt reflection { 0.1, 0.6 fresnel on } conserve_energy } normal { ripples 0.3 scale 0.3 } } interior_texture { pigment { rgbt <1, 0.3, 0.3, 0.5> } finish { Matt } } interior { ior 1.2 } rotate 30*y translate <2.2, -2, -2> Put() }
