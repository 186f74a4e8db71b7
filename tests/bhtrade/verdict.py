#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""bhtrade's figures against what pictures themselves say, whose colours are coordinates: verdict.py BHTRADE POVRAY

No ray ends here: every pixel of whole pictures tells by its colour, to seven digits, what place of what it shows.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, ROOT + "/tests/overlay")
import povray # noqa: E402
from povray import expect # noqa: E402

BHTRADE, POVRAY = map(os.path.realpath, sys.argv[1:3])
# Red, green and blue are x, y and z over R, from 0 to 1, and twice the kind of thing.
COORDINATES = """
#macro Coordinates(R, Kind)
	pigment { average pigment_map {
		[1 function { 0.5 + 0.5 * x / R } color_map { [0 rgb 6 * Kind * x] [1 rgb (6 * Kind + 3) * x] }]
		[1 function { 0.5 + 0.5 * y / R } color_map { [0 rgb 6 * Kind * y] [1 rgb (6 * Kind + 3) * y] }]
		[1 function { 0.5 + 0.5 * z / R } color_map { [0 rgb 6 * Kind * z] [1 rgb (6 * Kind + 3) * z] }]
	} }
#end
"""
SKY = COORDINATES + "sky_sphere { Coordinates(1.01, 0) }\n"
THINGS = SKY + """
#declare Matt = finish { ambient 1 diffuse 0 }
disc { <0, -1.5, 0>, y, 9, 3 Coordinates(10, 1) finish { Matt } }
sphere { <2, 0.5, 5>, 1.5 Coordinates(10, 2) finish { Matt } }
sphere { <-4, 1, 3>, 1 Coordinates(10, 3) finish { Matt } }
"""
CAMERA = "camera { location <0, 2.4, -18> up y right x*image_width/image_height angle 50 look_at 0 }\n"


def bhtrade(scene, *words):
	with tempfile.TemporaryDirectory() as folder:
		with open(folder + "/scene.pov", "w") as file:
			file.write(povray.HEAD + scene)
		done = subprocess.run([BHTRADE, "scene.pov", *words, "--json"], cwd=folder, capture_output=True, text=True, env={**os.environ, "HOME": folder})
		if done.returncode not in (0, 3):
			sys.exit(f"bhtrade: {done.stderr}")
		return json.loads(done.stdout), done.returncode


def seen(scene, width, height, words):
	"""{(x, y): (kind, colour)}; black in the horizon."""
	run = povray.Run(POVRAY, scene, f"+FE32 -D +W{width} +H{height} {words}")
	if run.code != 0:
		sys.exit(run.text)
	pixels = {}
	for i, p in enumerate(run.picture.rgba()):
		pixels[i % width, i // width] = -1 if max(p[:3]) == 0 else int(p[0] // 2), p[:3]
	return pixels


def errors(exact, other):
	"""Shifts, in pixels, where both show the same thing and the exact one shows it on all four sides; and how many pixels show
	a thing that the exact picture shows at none of the nine pixels there."""
	found, strange = [], 0
	for (x, y), (kind, colour) in other.items():
		around = [exact.get((x + i, y + j), (None,))[0] for i in (-1, 0, 1) for j in (-1, 0, 1)]
		strange += kind not in around
		if any(k != kind for k in around) or kind < 0:
			continue
		a, b = ([(q - p) / 2 for p, q in zip(exact[x - i, y - j][1], exact[x + i, y + j][1])] for i, j in ((1, 0), (0, 1)))
		d = [q - p for p, q in zip(exact[x, y][1], colour)]
		aa, ab, bb, ad, bd = (sum(p * q for p, q in zip(u, v)) for u, v in ((a, a), (a, b), (b, b), (a, d), (b, d)))
		if aa * bb - ab * ab > 1e-6 * (aa + bb) ** 2: # elsewhere seven digits do not tell
			found.append(math.hypot((ad * bb - bd * ab) / (aa * bb - ab * ab), (bd * aa - ad * ab) / (aa * bb - ab * ab)))
	return sorted(found), strange


# The sky alone: its light is followed exactly, so all that is off is that the frame at the effect radius counts as the
# coordinates': for a camera inside that looks at the hole, the picture is larger by 1/sqrt(1 - Rs/R).
W, H = 160, 120
out, code = bhtrade(SKY + CAMERA + "blackhole { 0, 1 effect_radius 200 tolerance 1e-2 }", f"+W{W}", f"+H{H}", "--pixels", "0.15")
r = math.hypot(18, 2.4)
capture = math.pi - math.acos((1.5 - r) * math.sqrt((r + 3) / (r**3 + 6.75))) # off the way in, in coordinates
per_tangent = W / 2 / math.tan(math.radians(25))
shadow = per_tangent * math.tan(capture) * math.sqrt((1 - 1 / r) / (1 - 1 / 200))
off = [math.hypot(x + 0.5 - W / 2, y + 0.5 - H / 2) for x in range(W) for y in range(H)]
off = sorted(p * (1 - math.sqrt(1 - 1 / 200)) if p > shadow else 0.0 for p in off)
own, = [s for s in out["settings"] if s["own"]]
print(f"sky: median {own['median']:.4f}, the formula says {off[len(off) // 2]:.4f}; 99.9 % {own['most']:.4f}, {off[int(0.999 * len(off))]:.4f}")
expect(abs(own["most"] / off[int(0.999 * len(off))] - 1) < 0.01, "sky: 99.9 %", own["most"], "formula", off[int(0.999 * len(off))])
expect(abs(own["median"] / off[len(off) // 2] - 1) < 0.01, "sky: median", own["median"], "formula", off[len(off) // 2])
best = out["recommended"]
expect(code == 0 and best["most"] <= 0.15 and best["effect_radius"] > 200, "sky: recommended", best)

# Things too: the picture at the recommended setting, pixel for pixel.
W, H, GOAL = 200, 150, 0.1
scene = THINGS + CAMERA + "blackhole { 0, 1 tolerance 2e-2 }"
out, code = bhtrade(scene, f"+W{W}", f"+H{H}", "--pixels", str(GOAL))
expect(code == 0, "things: nothing recommended")
exact = seen(scene, W, H, "Blackhole_Method=exact Blackhole_Tolerance=1e-8 Blackhole_Effect_Radius=1e7")
measured = []
chosen = [out["recommended"]] + [s for s in out["settings"] if s["own"]] + [s for s in out["settings"] if s["method"] == "rk4" and s["tolerance"] in (1e-2, 1e-3)]
for s in chosen:
	found, strange = errors(exact, seen(scene, W, H, " ".join(s["words"])))
	median, most = found[len(found) // 2], found[math.ceil(0.999 * len(found)) - 1]
	measured.append((most, strange))
	print(f"{' '.join(s['words']) or 'own':75} 99.9 %: bhtrade {s['most'] or math.inf:.4f}, pixels {most:.4f}; strange {strange}")
most, strange = measured[0]
expect(most <= GOAL, "things: the recommended setting is off by", most)
expect(strange <= 0.001 * W * H, "things: strange pixels at the recommended setting", strange)
expect(measured[1][0] > most and measured[1][0] > GOAL, "things: a coarse tolerance is not off by more", measured)
radii = [s["effect_radius"] for s in out["settings"]]
usual = max(radii, key=radii.count)
for method in ("rk4", "dopri5", "exact"):
	rows = sorted((s["tolerance"], s["most"] or math.inf) for s in out["settings"] if s["method"] == method and s["effect_radius"] == usual)
	expect(len(rows) > 1 and rows[0][1] < rows[-1][1], method, "coarse and fine:", rows)
sys.exit(povray.failures > 0)
