// SPDX-License-Identifier: AGPL-3.0-or-later
// Flat and smooth triangles, and one that is uv-mapped.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
mesh { #for (I, 0, 15) triangle { <0, 1.6, 0>, vrotate(1.4*x, I*22.5*y), vrotate(1.4*x, (I + 1)*22.5*y) } #end Checks(<1, 0.6, 0.2>, <0.5, 0.1, 0.1>) translate <3.4, 0, 2> Put() }
mesh2 { vertex_vectors { 4, <-1.5, -1.5, 0>, <1.5, -1.5, 0>, <1.5, 1.5, 0.5>, <-1.5, 1.5, 0.5> } uv_vectors { 4, <0, 0>, <1, 0>, <1, 1>, <0, 1> }
  face_indices { 2, <0, 1, 2>, <0, 2, 3> } texture { uv_mapping pigment { checker rgb <0.2, 0.6, 1> rgb 1 scale 0.25 } finish { Matt } } rotate 20*y translate <-3.4, 0.5, 2> Put() }
mesh { smooth_triangle { <-1.2, 0, 0>, <-1, 0.3, -1>, <1.2, 0, 0>, <1, 0.3, -1>, <0, 1.8, 0>, <0, 1, -1> } pigment { rgb <0.4, 1, 0.4> } finish { Matt phong 0.6 } translate <0, 2.4, 3> Put() }
