# SPDX-License-Identifier: AGPL-3.0-or-later
"""bhfarm render against one povray Reproducible=on, pixel for pixel: what hangs on chance, is cut unevenly or not at all, EXR, files beside and above the scene."""
import os
import subprocess

from farm import WORK, bhfarm, povray, same, scene

folder = WORK + "/project/scenes"
scene(folder)
os.makedirs(WORK + "/project/pictures")
os.makedirs(WORK + "/reference")
HEAD = '#version 3.7; global_settings { assumed_gamma 1 %s }\n#include "colors.inc"\ncamera { location <0, 2, -14> look_at 0 angle 40 }\nblackhole { 0, 1 effect_radius 20 tolerance 1e-2 }\n'
CHANCE = """light_source { <10, 20, -20> White area_light x*5, z*5, 3, 3 jitter }
plane { y, -3 pigment { checker Red Blue } finish { crand 0.3 } }
sphere { <3, 0, 2>, 1 pigment { Green } }
media { scattering { 1, 0.01 } method 1 intervals 3 samples 2 }
"""
RADIOSITY = "plane { y, -3 pigment { White } finish { diffuse 0.8 } }\nsphere { <3, 0, 2>, 1 pigment { Green } finish { emission 1 } }\n"


def compare(name, text, words=(), said="", options=(), exr=False):
    with open(folder + "/" + name + ".pov", "w") as f:
        f.write(text)
    size = ["+W60", "+H40", "Bits_Per_Color=16", *words]
    suffix = ".exr" if exr else ".png"
    povray("+I" + name + ".pov", folder, *size, "+O%s/reference/%s" % (WORK, name))
    done = bhfarm("render", name + ".pov", *size, *options, cwd=folder)
    assert said in done.stderr and (said or not done.stderr), done.stderr
    made, reference = folder + "/" + name + suffix, WORK + "/reference/" + name + suffix
    if exr: # decoded by another program to 32-bit floats
        raw = [subprocess.run(["ffmpeg", "-loglevel", "error", "-i", f, "-f", "rawvideo", "-pix_fmt", "gbrpf32le", "-"], capture_output=True) for f in (made, reference)]
        assert raw[0].stdout == raw[1].stdout and len(raw[0].stdout) >= 60 * 40 * 12, (raw[0].stderr, len(raw[0].stdout), len(raw[1].stdout))
    else:
        same(made, reference)


compare("chance", HEAD % "" + CHANCE, ["+A"], options=["--strips", "7"])
compare("uneven", HEAD % "" + CHANCE, ["+A", "+AM2"], options=["--strips", "40"])
compare("radiosity", HEAD % "ambient_light 0 radiosity { count 20 }" + RADIOSITY, options=["--strips", "4"])
compare("dither", HEAD % "" + CHANCE, ["+TH", "Bits_Per_Color=8"], said="rendered whole: dither")
compare("isosurface", HEAD % "" + CHANCE + "isosurface { function { x*x + y*y + z*z - 4 } max_gradient 1 evaluate 1, 1.2, 0.99 contained_by { sphere { 0, 3 } } translate <-4, 0, 2> "
        "pigment { Yellow } }\n", said="rendered whole: an isosurface")
compare("half", HEAD % "" + CHANCE, ["+FE"], options=["--strips", "3"], exr=True)
compare("float", HEAD % "" + CHANCE, ["+FE", "Bits_Per_Color=32"], options=["--strips", "3"], exr=True)
# Strips are parsed one after the other, and by many.
compare("moment", HEAD % "" + "#declare S = seed(mod(now, 1)*86400*1000);\nlight_source { <10, 20, -20> White }\nplane { y, -3 pigment { rgb <rand(S), rand(S), rand(S)> } }\n",
        options=["--strips", "7"])
# "radiosity" in a comment and in a string cuts all the same; a picture from above the scene's folder comes along.
os.rename(WORK + "/reference/dither.png", WORK + "/project/pictures/d.png")
compare("above", HEAD % "/* radiosity { } */" + CHANCE + '// radiosity {\n#declare S = "radiosity { }";\nbox { <-5, -2, 3>, <-3, 0, 4> pigment { image_map { png "../pictures/d.png" } } }\n',
        options=["--strips", "3"])
bad = bhfarm("render", "above.pov", "--strips", "41", "+W60", "+H40", cwd=folder, good=False)
assert bad.returncode == 1 and "a frame has 40 rows" in bad.stderr
print("9 pictures, cut or not, as from one povray")
