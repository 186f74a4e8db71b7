// SPDX-License-Identifier: AGPL-3.0-or-later
// Light from all around: samples go bent ways from each point.
// Turned limit 0.15: samples are taken in directions of the scene's axes
// Threads limit 1: POV-Ray's radiosity depends on which thread samples first
#include "world.inc"
global_settings { radiosity { count 30 nearest_count 4 pretrace_start 0.08 pretrace_end 0.04 recursion_limit 1 error_bound 1.5 } }
View(<0, 2, -14>, 0, 45) Hole(0)
sky_sphere { pigment { rgb <0.6, 0.7, 0.9> } }
plane { y, -3.1 pigment { rgb 0.8 } finish { diffuse 0.7 ambient 0 } Put() }
sphere { <3, -1, 2>, 1.5 pigment { rgb <1, 0.4, 0.3> } finish { diffuse 0.7 ambient 0 } Put() }
sphere { <-3, 0, 1>, 1 pigment { rgb <0.4, 1, 0.3> } finish { emission 0.8 ambient 0 } Put() }
