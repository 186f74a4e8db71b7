# SPDX-License-Identifier: AGPL-3.0-or-later
"""bhfarm render ended at moments of chance (Ctrl-C, a hangup, kill -9), also while it stitches and encodes, and the same command again until it is done: the pixels of one
povray, and nothing left over. Frames are there as they are finished. A seed may be given."""
import glob
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from farm import BIN, ENV, WORK, bhfarm, frames_in, povray, same, scene, wait

seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
dice = random.Random(seed)
folder = WORK + "/scene"
ini = scene(folder, frames=4, width=60, height=60)
os.makedirs(WORK + "/reference")
povray(ini, folder, "+O" + WORK + "/reference/film")
os.mkdir(WORK + "/path")
with open(WORK + "/path/ffmpeg", "w") as f: # encoding takes long enough to be hit
    f.write("#!/bin/bash\n[ \"$1\" = -version ] || { echo >>%s/encoding; sleep 1; }\nexec %s \"$@\"\n" % (WORK, shutil.which("ffmpeg")))
os.chmod(WORK + "/path/ffmpeg", 0o755)
ENV["PATH"] = WORK + "/path:" + ENV["PATH"]
ENV["TMPDIR"] = WORK + "/tmp"
os.mkdir(ENV["TMPDIR"])
state = ENV["HOME"] + "/.local/state/bhfarm/render"
words = ("render", "film.ini", "--slots", "2", "--strips", "4")
names = ["film%d.png" % n for n in range(1, 5)]
early, ended = False, []


def strips():
    return sum(len(files) for top, _, files in os.walk(state) if top.endswith("/strips"))


def whole():
    """Frames that are there are whole at any moment."""
    for name in names:
        if os.path.exists(folder + "/" + name):
            same(folder + "/" + name, WORK + "/reference/" + name)


# Before the first strip: what it had begun is gone, and it says so in a line.
moments = {"at once": lambda: True, "its fence is tried": lambda: os.listdir(ENV["TMPDIR"]), "it has a folder": lambda: os.path.isdir(state) and os.listdir(state),
           "its server listens": lambda: glob.glob(state + "/*/spool/url"), "a scene is tried out": lambda: glob.glob(ENV["TMPDIR"] + "/*/here"),
           "the job is there": lambda: glob.glob(state + "/*/spool/jobs/*")}
for what, here in moments.items():
    process = subprocess.Popen([BIN + "/bhfarm", *words], cwd=folder, env=ENV, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while not here() and process.poll() is None:
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    begun = "goes on where it was" in said
    assert process.returncode == (130 if said else -signal.SIGINT) and (begun or said in ("", "bhfarm: stopped before anything was rendered\n")), (what, process.returncode, said)
    assert os.listdir(ENV["TMPDIR"]) == [], (what, os.listdir(ENV["TMPDIR"]))
    assert begun or not os.path.isdir(state) or os.listdir(state) == [], (what, said, os.listdir(state))
    shutil.rmtree(state, ignore_errors=True)

for round in range(7):
    process = subprocess.Popen([BIN + "/bhfarm", *words], cwd=folder, env=ENV, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    how = dice.choice((signal.SIGINT, signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL))
    if round == 5: # the last but one, while it encodes
        wait(lambda: os.path.exists(WORK + "/encoding") or process.poll() is not None, "the film", seconds=120)
    else: # a moment after the next strip
        before = strips()
        wait(lambda: strips() > before or os.path.exists(WORK + "/encoding") or process.poll() is not None, "a strip", seconds=120)
    time.sleep(dice.uniform(0, 0.6))
    early = early or any(os.path.exists(folder + "/" + n) for n in names) and process.poll() is None
    process.send_signal(how)
    said = process.communicate(timeout=60)[1]
    ended.append((how.name, process.returncode))
    assert process.returncode in (0, 130, -how), (how, process.returncode, said)
    if process.returncode == 0:
        break
    whole()
if process.returncode != 0:
    for tries in range(20): # a server of before, killed without its master, may take a moment to go
        done = bhfarm(*words, cwd=folder, good=False)
        if done.returncode == 0:
            break
        assert "another bhfarm-server" in done.stderr or "is being rendered already" in done.stderr, done.stderr
        time.sleep(0.5)
    assert done.returncode == 0, done.stderr
    assert [os.path.basename(f) for f in done.stdout.split()] == names + ["film.mp4"], done.stdout
for name in names:
    assert os.path.exists(folder + "/" + name)
whole()
assert early, "no frame was there before the end"
assert os.listdir(state) == [], os.listdir(state)
assert sorted(f for f in os.listdir(folder) if f.startswith("film")) == sorted(names + ["film.mp4", "film.ini", "film.pov"]), os.listdir(folder)
assert frames_in(folder + "/film.mp4") == 4
print("seed %d, ended by %s: the same pixels" % (seed, ", ".join("%s (%d)" % e for e in ended)))
