// SPDX-License-Identifier: AGPL-3.0-or-later
// Light that seeps through marble.
// Threads limit 1: each thread has its own random points
#include "world.inc"
global_settings { mm_per_unit 10/Size subsurface { samples 12, 4 } }
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.5)
sphere { <3, 0, 1>, 1.3 pigment { rgb <0.9, 0.8, 0.7> } finish { ambient 0 diffuse 0.6 specular 0.3 subsurface { translucency 0.4 } } interior { ior 1.4 } Put() }
