// SPDX-License-Identifier: AGPL-3.0-or-later
// Media of the whole scene, without end, over a floor.
#include "world.inc"
View(<0, 2, -14>, 0, 50) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
media { absorption <0.02, 0.03, 0.04>/Size samples 3 }
sphere { <3, 1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
