#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Whether a sample stands for the whole picture, antialiased or not, where each ray takes the same time: times.py BHTRADE POVRAY"""
import os
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path[:0] = [ROOT + "/tests/overlay", ROOT + "/tools/bhtrade"]
import povray # noqa: E402
import runs # noqa: E402
from povray import expect # noqa: E402

with tempfile.TemporaryDirectory() as folder:
	with open(folder + "/scene.pov", "w") as file:
		file.write(povray.HEAD + "camera { location -9*z } plane { -z, -9 pigment { checker rgb 0 rgb 1 scale 1e-3 } finish { ambient 1 } }")
	for words in ([], ["+A0.0"], ["+A0.0", "+R2"]):
		run = runs.Povray(os.path.realpath(sys.argv[2]), [f"+I{folder}/scene.pov", "+W320", "+H192", *words])
		sample = run.time(runs.Setting(), 7)
		text, wall = run.run(["Render_Block_Size=32"])
		whole = runs.Times(text, wall)
		rays = whole.pixels + (whole.added or 0)
		sample.parts = {"Trace": sample.pixels + (sample.added or 0)}
		said = sample.whole(0)
		expect(abs(said - rays) < 0.02 * rays, words, "rays of the whole picture:", rays, "expected of the sample:", said)
sys.exit(povray.failures > 0)
