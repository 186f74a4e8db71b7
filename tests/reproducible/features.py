# SPDX-License-Identifier: AGPL-3.0-or-later
"""For each of POV-Ray's features that draws random numbers, or remembers something from pixel to pixel, a scene that shows it."""

HOLE = "blackhole { 0, 1 tolerance 1e-2 }\n"
CAMERA = "camera { location <0, 2, -14> look_at <0, 0.5, 0> angle 42 %s }\n"
SUN = "light_source { <10, 20, -20>, 0.8 }\n"
SKY = "sky_sphere { pigment { bozo scale 0.2 color_map { [0 rgb <0.02, 0.2, 0.6>] [1 rgb <0.9, 0.8, 0.5>] } } }\n"
GROUND = "plane { y, -2 pigment { checker rgb 0.9, rgb <0.5, 0.2, 0.1> } %s }\n"
BALLS = """
sphere { <-3, 0, 0>, 1.2 pigment { crackle scale 0.4 color_map { [0 rgb 0] [0.4 rgb <1, 0.5, 0.3>] } } normal { facets size 1 scale 0.2 } finish { reflection 0.2 phong 0.7 } }
sphere { <3, 0, 2>, 1.3 pigment { rgbf <0.9, 1, 0.9, 0.8> } finish { reflection 0.1 } interior { ior 1.4 } }
box { <-1, 2, 3>, <1, 4, 5> pigment { granite scale 2 } }
"""
PLAIN = SUN + SKY + GROUND % "" + BALLS

AREA = "light_source { <10, 20, -20>, 0.8 area_light 8*x, 8*y, 4, 4 jitter %s }\n"
FOG = "box { <-4, -2, -4>, <-1.5, 1, 2> hollow pigment { rgbt 1 } interior { media { %s scattering { 1, 0.05 extinction 0.6 } density { bozo scale 0.7 } } } }\n"
MEDIA = SUN + GROUND % "" + "sphere { <-3, 0, 0>, 1.2 pigment { rgb 1 } }\n" + FOG
RADIOSITY = "global_settings { radiosity { pretrace_start 0.08 pretrace_end 0.04 count 40 nearest_count 4 error_bound 0.7 recursion_limit 2 low_error_factor 0.8 %s } }\n"
LIT = "background { rgb <0.3, 0.4, 0.6> } sphere { <4, 6, 2>, 1.5 pigment { rgb <1, 0.7, 0.3> } finish { emission 3 diffuse 0 } }\n" + "default { finish { ambient 0 } }\n" + GROUND % "" + BALLS

# Name: (what stands in the camera, the rest of the scene, options, whether strips are known to differ without Reproducible=on, or only "threads").
FEATURES = {
	"plain": ("", PLAIN, "-A", False),
	"am1": ("", PLAIN, "+A0.1 +AM1 +R2 +J", True), # by where the cuts are
	"am2": ("", PLAIN, "+A0.1 +AM2 +R2 +J", False),
	"blur": ("aperture 0.6 focal_point <-3, 0, 0> blur_samples 19 variance 1/1000", PLAIN, "-A", False),
	"area": ("", AREA % "adaptive 1" + AREA % "" + SKY + GROUND % "" + BALLS, "-A", True),
	"crand": ("", SUN + SKY + GROUND % "finish { crand 0.3 }" + BALLS, "-A", True),
	"media1": ("", MEDIA % "method 1 intervals 3 samples 2, 4 confidence 0.9 variance 1/100", "-A", True),
	"media2": ("", MEDIA % "method 2 samples 6 jitter 1", "-A", True),
	"media3": ("", MEDIA % "method 3 samples 5 jitter 0.8 aa_level 3 aa_threshold 0.05", "-A", True),
	"media-area": ("", AREA % "" + MEDIA % "method 1 intervals 2 samples 1, 2" + "sphere { <2, 3, -3>, 0.8 pigment { rgbf 0.9 } interior { media { method 1 intervals 1 absorption 0.5 density { granite } } } hollow }\n", "+A0.2 +AM2 +R1", True),
	# A light blocked by a ball: where the ball is tried first, the jittered medium under it draws nothing, and later ones other numbers.
	"shadow-cache": ("", "light_source { <-4, 20, -2>, 0.5 }\n" + AREA % "" + GROUND % "" + "sphere { <-4, 4, 0>, 2 pigment { rgb 1 } }\n" +
		"box { <-5, -1.5, -2>, <-3.6, 0, 2> hollow pigment { rgbt 1 } interior { media { method 3 samples 3 jitter 1 absorption 0.5 density { granite scale 0.3 } } } }\n", "-A", True),
	"subsurface": ("", "global_settings { mm_per_unit 20 subsurface { samples 8, 4 } }\n" + SUN + SKY + "default { finish { ambient 0.1 } }\n" +
		"sphere { <-3, 0, 0>, 1.5 pigment { rgb 0.9 } finish { subsurface { translucency <0.4, 0.3, 0.2> } } interior { ior 1.4 } }\n" +
		"box { <1.5, -2, -1>, <4, 1, 2> pigment { rgb 0.9 } finish { subsurface { translucency <0.2, 0.3, 0.5> } } interior { ior 1.3 } }\n", "-A", True),
	"rainbow": ("", PLAIN + "rainbow { angle 25 width 15 distance 1e3 direction <0, 0.1, 1> jitter 0.3 color_map { [0 rgbt <1, 0.5, 0.5, 1>] [0.3 rgbt <1, 0.2, 0.2, 0.2>] [0.7 rgbt <0.2, 0.2, 1, 0.2>] [1 rgbt <0.5, 0.5, 1, 1>] } }\n", "-A", True),
	"photons": ("", "global_settings { photons { count 20000 media 20 jitter 0.5 } }\n" + SUN + "light_source { <-9, 9, -9>, 0.4 }\n" + GROUND % "" +
		"torus { 0.8, 0.2 translate <-3, -1, 0> pigment { rgb 0.2 } finish { reflection 0.8 } photons { target reflection on } }\n" +
		"sphere { <3, 0, 2>, 1.3 pigment { rgbf 0.95 } interior { ior 1.4 } photons { target reflection on refraction on } }\n" +
		"box { <1.5, -2, -4>, <7, 1, 3> hollow pigment { rgbt 1 } interior { media { method 3 samples 3 scattering { 1, 0.02 } } } }\n", "-A", "threads"),
	"radiosity": ("", RADIOSITY % "" + LIT, "-A", True),
	"radiosity-always": ("", RADIOSITY % "count 12 always_sample on normal on media on" + AREA % "" + LIT + FOG % "method 1 samples 1, 1 intervals 1", "+A0.3 +AM1 +R1", True),
}
