// SPDX-License-Identifier: AGPL-3.0-or-later
// Constant fogs, one with a least transmittance and one that filters.
#include "world.inc"
View(<0, 2, -14>, 0, 50) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
fog { distance 25*Size color rgbt <0.55, 0.6, 0.7, 0.15> }
fog { distance 60*Size color rgbf <0.7, 0.5, 0.4, 0.3> }
sphere { <3, 1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
