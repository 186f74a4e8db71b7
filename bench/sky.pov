// SPDX-License-Identifier: AGPL-3.0-or-later
// A sky alone, three quarters of the picture bent: what following a ray costs.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 0, -30> angle 40 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.1, 0.1, 0.3>] [1 rgb <0.8, 0.9, 1>] } scale 2 translate -1 } }
blackhole { 0, 1 effect_radius 9.2 tolerance Tol }
