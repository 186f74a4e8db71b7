// SPDX-License-Identifier: AGPL-3.0-or-later
// A glowing ring of dust about the hole before a sky: media are sampled on every chord inside it.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -24> look_at 0 angle 50 }
light_source { <20, 30, -30> rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb 0.02] [1 rgb <0.1, 0.2, 0.4>] } scale 2 translate -1 } }
difference {
	cylinder { -1.2 * y, 1.2 * y, 9 }
	cylinder { -1.3 * y, 1.3 * y, 4 }
	pigment { rgbt 1 }
	hollow
	interior { media { emission <0.3, 0.2, 0.1> absorption 0.05 samples 5 intervals 1 method 3 density { spherical scale 10 } } }
}
plane { y, -6 pigment { checker rgb 0.3 rgb 0.6 } }
blackhole { 0, 1 effect_radius 12 tolerance Tol }
