// SPDX-License-Identifier: AGPL-3.0-or-later
// Fog lit by a lamp, in a box with a ball in it.
// Straight limit 0.08: POV-Ray samples the edge of a shadow along a ray as coarsely as it is told to
#include "world.inc"
View(<0, 2, -14>, 0, 45) Hole(0) Sky() Lamp(<8, 12, -6>, rgb 1.5)
box { -4, 4 pigment { rgbt 1 } hollow interior { media { scattering { 1, 0.03/Size extinction 0 } samples 12 } } Put() }
sphere { <2.6, 1, 2>, 1 Checks(<1, 0.3, 0.2>, 0.9) Put() }
