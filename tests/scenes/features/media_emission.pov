// SPDX-License-Identifier: AGPL-3.0-or-later
// A ball of glowing fog round the hole, and one that absorbs: a ray shines and fades by its length in them.
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky()
sphere { <-1.5, 0, 0>, 4 pigment { rgbt 1 } hollow
  interior { media { emission <0.07, 0.04, 0.02>/Size samples 4 } } Put() }
sphere { <4.4, 0, 2>, 1.7 pigment { rgbt 1 } hollow interior { media { absorption <0.1, 0.2, 0.3>/Size samples 4 } } Put() }
