// SPDX-License-Identifier: AGPL-3.0-or-later
// Fogs with turbulence.
// Turned limit 1: POV-Ray's turbulence of fog has its place in the scene's axes
// Scale limit 1: and its size in the scene's units
#include "world.inc"
View(<0, 2, -14>, 0, 50) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
fog { distance 60*Size color rgb <0.7, 0.5, 0.4> turbulence 0.4 turb_depth 0.6 }
fog { fog_type 2 distance 6*Size color rgb <0.6, 0.65, 0.7> fog_offset -2*Size fog_alt 0.9*Size up Along(y) turbulence 0.8 turb_depth 0.5 }
sphere { <3, 1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
