// SPDX-License-Identifier: AGPL-3.0-or-later
// Fog that thins out upwards.
#include "world.inc"
View(<0, 2, -14>, 0, 50) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
fog { fog_type 2 distance 6*Size color rgb <0.6, 0.65, 0.7> fog_offset -2*Size fog_alt 0.9*Size up Along(y) }
sphere { <3, 1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
