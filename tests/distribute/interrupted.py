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

from farm import BIN, ENV, PATIENCE, WORK, bhfarm, frames_in, povray, same, scene, wait

seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
dice = random.Random(seed)
folder = WORK + "/scene"
ini = scene(folder, frames=4, width=60, height=60)
os.makedirs(WORK + "/reference")
povray(ini, folder, "+O" + WORK + "/reference/film")
os.mkdir(WORK + "/path")
with open(WORK + "/path/ffmpeg", "w") as f: # encoding lasts until the end, when it is let go on: none but the last is done
    f.write("#!/bin/bash\n[ \"$1\" = -version ] || { echo >>%s/encoding; while [ -e %s/hold ]; do sleep 0.05; done; }\nexec %s \"$@\"\n" % (WORK, WORK, shutil.which("ffmpeg")))
open(WORK + "/hold", "w").close()
os.chmod(WORK + "/path/ffmpeg", 0o755)
ENV["PATH"] = WORK + "/path:" + ENV["PATH"]
ENV["TMPDIR"] = WORK + "/tmp"
os.mkdir(ENV["TMPDIR"])
state = ENV["HOME"] + "/.local/state/bhfarm/render"
words = ("render", "film.ini", "--slots", "2", "--strips", "4")
names = ["film%d.png" % n for n in range(1, 5)]
ended = []


def strips():
    return sum(len(files) for top, _, files in os.walk(state) if top.endswith("/strips"))


def whole():
    """Frames that are there are whole at any moment."""
    for name in names:
        if os.path.exists(folder + "/" + name):
            same(folder + "/" + name, WORK + "/reference/" + name)


def alive(pid):
    try:
        return open("/proc/%s/stat" % pid).read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


# Before the first strip: what it had begun is gone, and it says so in a line.
moments = {"at once": lambda: True, "its fence is tried": lambda: os.listdir(ENV["TMPDIR"]), "it has a folder": lambda: os.path.isdir(state) and os.listdir(state),
           "its server listens": lambda: glob.glob(state + "/*/spool/url"), "a scene is tried out": lambda: glob.glob(ENV["TMPDIR"] + "/*/here"),
           "the job is there": lambda: glob.glob(state + "/*/spool/jobs/*")}
for what, here in moments.items():
    process = subprocess.Popen([BIN + "/bhfarm", *words], cwd=folder, env=ENV, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while not here() and process.poll() is None:
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=PATIENCE)[1]
    begun = "goes on where it was" in said
    assert process.returncode == (130 if said else -signal.SIGINT) and (begun or said in ("", "bhfarm: stopped before anything was rendered\n")), (what, process.returncode, said)
    assert os.listdir(ENV["TMPDIR"]) == [], (what, os.listdir(ENV["TMPDIR"]))
    assert begun or not os.path.isdir(state) or os.listdir(state) == [], (what, said, os.listdir(state))
    shutil.rmtree(state, ignore_errors=True)

for round in range(7):
    if os.path.exists(WORK + "/encoding"):
        os.remove(WORK + "/encoding")
    process = subprocess.Popen([BIN + "/bhfarm", *words], cwd=folder, env=ENV, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    how = dice.choice((signal.SIGINT, signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL))
    if round == 5: # the last but one, while it encodes: by then frames are there
        wait(lambda: os.path.exists(WORK + "/encoding") and all(os.path.exists(folder + "/" + name) for name in names), "frames before the end", process)
    else: # a moment after the next strip
        before = strips()
        wait(lambda: strips() > before or os.path.exists(WORK + "/encoding"), "a strip", process)
    time.sleep(dice.uniform(0, 0.6))
    others = open("/proc/%d/task/%d/children" % (process.pid, process.pid)).read().split()
    process.send_signal(how)
    said = process.communicate(timeout=PATIENCE)[1]
    ended.append((how.name, process.returncode))
    assert process.returncode in (130, -how), (how, process.returncode, said)
    wait(lambda: not any(map(alive, others)), "server and worker to go without their master")
    whole()
os.remove(WORK + "/hold")
done = bhfarm(*words, cwd=folder)
assert [os.path.basename(f) for f in done.stdout.split()] == names + ["film.mp4"], done.stdout
for name in names:
    assert os.path.exists(folder + "/" + name)
whole()
assert os.listdir(state) == [], os.listdir(state)
assert sorted(f for f in os.listdir(folder) if f.startswith("film")) == sorted(names + ["film.mp4", "film.ini", "film.pov"]), os.listdir(folder)
assert frames_in(folder + "/film.mp4") == 4
print("seed %d, ended by %s: the same pixels" % (seed, ", ".join("%s (%d)" % e for e in ended)))
