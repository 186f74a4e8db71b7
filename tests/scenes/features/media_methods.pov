// SPDX-License-Identifier: AGPL-3.0-or-later
// All three ways to sample, and a density that varies.
// Straight limit 0.06: methods 1 and 2 sample at random
// Threads limit 0.5: methods 1 and 2 draw from a random sequence of each thread
#include "world.inc"
View(<0, 1, -14>, 0, 50) Hole(0) Sky()
#macro Cloud(P, M) sphere { 0, 1.9 pigment { rgbt 1 } hollow
  interior { media { method M absorption <0.2, 0.5, 0.8>/Size intervals (M = 3 ? 1 : 20) samples 20, 30
    density { spherical scale 1.9 color_map { [0 rgb 0] [1 rgb 2] } } } } translate P Put() } #end
Cloud(<-4.2, 0, 0>, 1) Cloud(<4.2, 0, 1>, 2) Cloud(<0, 3.6, 3>, 3)
