# SPDX-License-Identifier: AGPL-3.0-or-later
"""Everything that hangs on chance or on the whole frame, through the farm: frames of tests/reproducible's features (each with a black hole) in 3, 7 and uneven
strips by several workers in any order have the pixels of one povray's whole frame with two threads."""
import os
import sys
import time

from farm import BIN, WORK, Server, bhfarm, pixels, povray, same, wait

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)) + "/../reproducible")
from features import CAMERA, FEATURES, HOLE # noqa: E402

WIDTH, HEIGHT = 64, 48
ROWS = (16, 7, 1 + HEIGHT // 3 * 2) # of a strip: 3, 7, and two of unlike size
folder = WORK + "/scenes"
os.makedirs(folder)
os.makedirs(WORK + "/reference")
scenes = {name: (CAMERA % camera + body + HOLE, options.split() + ["Bits_Per_Color=16"]) for name, (camera, body, options, _) in FEATURES.items()}
scenes["dither"] = (scenes["plain"][0], ["Dither=On", "Bits_Per_Color=8"])

server = Server("--check-every", "0")
workers = [server.worker("--slots", "1", name="one%d" % i) for i in (1, 2)]
began = time.monotonic()
jobs = []
for name, (text, words) in scenes.items():
    with open("%s/%s.pov" % (folder, name), "w") as f:
        f.write("#version 3.7;\n" + text)
    words = [name + ".pov", "+W%d" % WIDTH, "+H%d" % HEIGHT, *words]
    done = bhfarm("submit", *words, "--strips", "3", server=server, cwd=folder)
    number = int(done.stdout)
    spec = server.job(number)["spec"]
    jobs.append((name, number))
    if spec["whole_because"]:
        assert spec["strip_rows"] == HEIGHT and spec["whole_because"] in done.stderr, (name, done.stderr)
        assert name == "dither", name + " is not cut: " + spec["whole_because"]
        continue
    assert spec["strip_rows"] == ROWS[0], spec
    for rows in ROWS[1:]:
        status, answer = server.ask("/v1/jobs", dict(spec, strip_rows=rows, client_key=""))
        assert status == 201, answer
        jobs.append((name, answer["job"]))
for name, (text, words) in scenes.items():
    povray("+I" + name + ".pov", folder, "+W%d" % WIDTH, "+H%d" % HEIGHT, *words, "+O%s/reference/%s" % (WORK, name))
for name, number in jobs:
    wait(lambda: server.job(number)["stage"] != "running", "%s, job %d" % (name, number), log=server.log)
    assert server.job(number)["stage"] == "done", (name, server.job(number))
    bhfarm("fetch", str(number), "--to", WORK + "/out%d" % number, server=server)
    same("%s/out%d/%s.png" % (WORK, number, name), "%s/reference/%s.png" % (WORK, name))
assert len({pixels("%s/reference/%s.png" % (WORK, name)) for name in scenes}) == len(scenes), "two features show the same"

# On one machine the first strip of a frame leaves radiosity's pretrace to the others.
with open(WORK + "/povray", "w") as f:
    f.write('#!/bin/bash\n%s/povray "$@" || exit # on a busy machine it may not begin, and is called again\ngrep -o "^Radiosity_.*_File=On" "$POVINI" >>%s/light 2>/dev/null || true\n' % (BIN, WORK))
os.chmod(WORK + "/povray", 0o700)
lone = Server("--check-every", "0")
text, words = scenes["radiosity"]
number = int(bhfarm("submit", "radiosity.pov", "+W%d" % WIDTH, "+H%d" % HEIGHT, *words, "--strips", "7", server=lone, cwd=folder).stdout)
lone.worker("--no-sandbox", "--povray", WORK + "/povray", name="lone")
wait(lambda: lone.job(number)["stage"] == "done", "radiosity by one worker", log=lone.log)
bhfarm("fetch", str(number), "--to", WORK + "/lone", server=lone)
same(WORK + "/lone/radiosity.png", WORK + "/reference/radiosity.png")
shared = open(WORK + "/light").read().split()
assert shared == ["Radiosity_To_File=On"] + ["Radiosity_From_File=On"] * 6, shared
print("%d features in %d jobs: the pixels of whole frames, %.0f s" % (len(scenes), len(jobs), time.monotonic() - began))
