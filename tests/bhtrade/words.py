#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""What bhtrade makes of its words, good and bad: words.py BHTRADE POVRAY"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, ROOT + "/tests/overlay")
import povray # noqa: E402
from povray import expect # noqa: E402

BHTRADE, POVRAY = map(os.path.realpath, sys.argv[1:3])
SCENE = povray.HEAD + """
#ifndef (Where) #declare Where = -15; #end
camera { location <0, 1, Where> look_at 0 }
sphere { <2, 0.5, 5 - 3 * clock>, 1.5 pigment { rgb 1 } finish { ambient 1 } }
blackhole { 0, 1 effect_radius 1000 tolerance 1e-2 }
"""
FILES = {"scene.pov": SCENE, "a folder/with spaces.pov": SCENE, "none.pov": povray.HEAD + "sphere { 5*z, 1 }",
	"broken.pov": povray.HEAD + "blackhole { 0,\nnonsense }",
	"two.pov": povray.HEAD + "camera { location -20*z look_at 0 } sphere { 9*z, 2 } blackhole { -4*x, 0.5 effect_radius 3 } blackhole { 4*x, 1 effect_radius 4 }",
	"film.ini": "Input_File_Name=scene.pov\nWidth=40\nHeight=30\nInitial_Frame=1\nFinal_Frame=9\n"}
folder = tempfile.TemporaryDirectory()
os.mkdir(folder.name + "/a folder")
for name, text in FILES.items():
	with open(f"{folder.name}/{name}", "w") as file:
		file.write(text)


def bhtrade(*words):
	return subprocess.run([BHTRADE, *words], cwd=folder.name, capture_output=True, text=True, env={**os.environ, "HOME": folder.name})


# Nothing on stdout, one line on stderr that says what is wrong, and the exit code for it.
for code, says, *words in ((2, "there is no scene 'nosuch.pov'", "nosuch.pov"), (2, "no scene", "+W80"), (2, "no option --pixel", "scene.pov", "--pixel=1"),
	(2, "--pixels needs a number above 0, not -1", "scene.pov", "--pixels", "-1"), (2, "--seconds needs a number", "scene.pov", "--seconds"),
	(2, "--pixels needs a number above 0, not nan", "scene.pov", "--pixels=nan"), (2, "not both", "scene.pov", "--pixels=1", "--seconds=1"),
	(2, "+SR10: the whole picture", "scene.pov", "+SR10"), (1, "no black hole in the scene", "none.pov"),
	(1, "no black hole in the scene", "scene.pov", "Blackhole=off"), (1, "'broken.pov' line 3", "broken.pov"),
	(1, "Blackhole_Tolerance=1: must be between", "scene.pov", "Blackhole_Tolerance=1"), (1, "horizon", "scene.pov", "Declare=Where=0")):
	done = bhtrade(*words)
	expect(done.returncode == code and done.stdout == "" and says in done.stderr and done.stderr.count("\n") == 1, words, done)

help_text = bhtrade("--help")
expect(help_text.returncode == 0 and "Usage: bhtrade scene.pov" in help_text.stdout, "no help:", help_text)

# A table, and a line that the scene takes; nothing but these, and nothing left behind.
before = sorted(os.listdir(folder.name))
done = bhtrade("a folder/with spaces.pov", "+W40", "+H30", "Declare=Where = -12", "--pixels", "0.02")
expect(done.returncode == 0 and done.stderr == "" and "recommended" in done.stdout and "40 x 30" in done.stdout, done)
advice = [line.strip() for line in done.stdout.splitlines() if line.strip().startswith("tolerance ")]
expect(len(advice) == 1, "what to write into the scene:", done.stdout)
expect(povray.Run(POVRAY, SCENE.replace("tolerance 1e-2", "".join(advice)), "+W20 +H15 -D").code == 0, "the scene does not take", advice)
expect(sorted(os.listdir(folder.name)) == before, "left behind:", os.listdir(folder.name))

# A goal that nothing keeps: the table all the same.
done = bhtrade("scene.pov", "+W40", "+H30", "--seconds", "1e-3")
expect(done.returncode == 3 and "no setting takes 0.001 s or less; the quickest" in done.stderr and "99.9 %" in done.stdout, done)

# A film's frame half-way stands for all; several holes keep their radii.
# The time is nine frames', not one's; half of nine is left to the noise of two measurements of what comes before tracing.
film = json.loads(bhtrade("film.ini", "--json", "--seconds", "1000").stdout)
expect((film["frames"], film["width"]) == (9, 40) and film["recommended"]["seconds"] > 4.5 * film["before"] > 0, film)
two = json.loads(bhtrade("two.pov", "+W40", "+H30", "--json").stdout)
expect(len(two["holes"]) == 2 and all(s["effect_radius"] is None for s in two["settings"]) and two["recommended"], two)

# Whatever ends it, the povray that it runs ends too, and nothing is left behind; a reader that has enough is no error of ours.
scratch = tempfile.TemporaryDirectory()
for end in 3 * (signal.SIGTERM, signal.SIGHUP, signal.SIGINT): # at once, when povray is hardly there
	running = subprocess.Popen([BHTRADE, "scene.pov", "+W2000", "+H2000"], cwd=folder.name, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
		env={**os.environ, "HOME": folder.name, "TMPDIR": scratch.name})
	children, until = [], time.monotonic() + 600
	while not children and running.poll() is None and time.monotonic() < until:
		with open(f"/proc/{running.pid}/task/{running.pid}/children") as file:
			children = file.read().split()
	running.send_signal(end)
	said = running.communicate()
	expect(running.returncode == 128 + end and said == ("", ""), end, running.returncode, said)
	expect(children and not os.path.exists(f"/proc/{children[0]}"), end, "left a povray running:", children)
	expect(os.listdir(scratch.name) == [], end, "left behind:", os.listdir(scratch.name))
enough = subprocess.Popen([BHTRADE, "--help"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
enough.stdout.close()
expect(enough.stderr.read() == "" and enough.wait() == 141, "a closed pipe:", enough.returncode)
sys.exit(povray.failures > 0)
