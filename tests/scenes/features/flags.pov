// SPDX-License-Identifier: AGPL-3.0-or-later
// Objects that are in the picture, in mirrors, or in shadows only; hollow and double-lit ones.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.3)
box { <-6, -3, 6>, <6, 5, 6.1> pigment { rgb 0.05 } finish { reflection 0.8 ambient 0 diffuse 0.1 } Put() }
sphere { <3.2, 0, 1>, 1 no_image Checks(<1, 0.3, 0.2>, 0.9) Put() }
sphere { <-3.2, 0, 1>, 1 no_reflection Checks(<0.2, 1, 0.3>, 0.9) Put() }
sphere { <0, 3, 0>, 0.8 no_shadow Checks(<0.2, 0.3, 1>, 0.9) Put() }
disc { <-2, -1.6, -2>, <0, 0.2, 1>, 0.8 double_illuminate pigment { rgb <1, 1, 0.5> } finish { Matt } Put() }
