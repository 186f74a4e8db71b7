// SPDX-License-Identifier: AGPL-3.0-or-later
// Filters and transmittances in the way of light and of sight, with alpha.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.5)
#for (I, 0, 5) sphere { <3.4*cos(I*pi/3), 0.4*sin(I*2) + 0.5, 3.4*sin(I*pi/3)>, 0.9 pigment { rgbft <0.5 + 0.5*cos(I), 0.5 + 0.5*cos(I + 2), 0.5 + 0.5*cos(I + 4), 0.5, 0.3> } finish { Matt } Put() } #end
