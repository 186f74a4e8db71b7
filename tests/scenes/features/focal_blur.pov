// SPDX-License-Identifier: AGPL-3.0-or-later
// A lens: many origins, each its own rays.
// Turned limit 0.1: the points of the lens are not a mirror image of themselves
#include "world.inc"
camera { location <0, 2, -14>*Size right x*image_width/image_height look_at 0 angle 45 aperture 0.8*Size focal_point 0 blur_samples 9 variance 0 confidence 0.9 transform { Turn } }
Hole(0) Sky() Floor() Lamp(<8, 12, -6>, rgb 1.2)
sphere { <3, 1, 4>, 1.2 Checks(<1, 0.3, 0.2>, 0.9) Put() }
sphere { <-2, -1, -4>, 0.8 Checks(<0.3, 1, 0.2>, 0.9) Put() }
