// SPDX-License-Identifier: AGPL-3.0-or-later
// Photons go straight for now; what they lit is seen along bent ways.
// Scale limit 0.04: photons are few, and gathered within a radius that starts from the spacing in scene units
#include "world.inc"
global_settings { photons { count 6000 autostop 0 } }
View(<0, 3, -14>, <0, -1, 0>, 45) Hole(<0, 0.5, 2>) Sky() Lamp(<6, 14, -8>, rgb 1.3)
plane { y, -3.1 pigment { rgb 0.8 } finish { Matt } Put() }
sphere { <-2.4, -1, -1.5>, 1.2 pigment { rgbf 0.95 } finish { ambient 0 diffuse 0 specular 0.5 } interior { ior 1.5 } photons { target refraction on reflection off } Put() }
