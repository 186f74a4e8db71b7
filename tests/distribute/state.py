# SPDX-License-Identifier: AGPL-3.0-or-later
"""Where things are kept: two renders never write the same files, a folder that cannot be made is named, and without HOME it is the user's own home, never /tmp."""
import os
import subprocess

from farm import BIN, ENV, FENCED, WORK, bhfarm, povray, same, scene, start, wait

folder = WORK + "/scene"
ini = scene(folder, frames=2, width=48, height=40)
os.makedirs(WORK + "/reference")
povray(ini, folder, "+O" + WORK + "/reference/film")
kept = ENV["HOME"] + "/.local/state/bhfarm"


def says(text, *words, env=ENV, code=1, program="bhfarm"):
    """One line with the text in it."""
    done = subprocess.run([BIN + "/" + program, *words], env=env, cwd=folder, capture_output=True, text=True)
    assert done.returncode == code and done.stderr.count("\n") == 1 and text in done.stderr and not done.stdout, (words, done)


# The first is at work for as long as the test wants.
os.makedirs(WORK + "/out")
with open(WORK + "/povray", "w") as f:
    f.write("#!/bin/bash\nwhile [ ! -e %s/go ]; do sleep 0.05; done\nexec %s/povray \"$@\"\n" % (WORK, BIN))
os.chmod(WORK + "/povray", 0o700)
out = "+O" + WORK + "/out/"
first = start("bhfarm", "render", ini, "--no-sandbox", "--povray", WORK + "/povray", out + "film", log=WORK + "/first.log")
wait(lambda: os.path.isdir(kept + "/render") and os.listdir(kept + "/render"), "the first", first, WORK + "/first.log")
before = os.listdir(kept + "/render")
os.symlink(WORK + "/out", WORK + "/link")
says("at work on %s/out/film.mp4" % WORK, "render", "film.ini", "+W32", out + "film")
says("at work on %s/out/film.png" % WORK, "render", "film.ini", "+W32", out + "film", "--video", "none")
says("at work on %s/link/film.png" % WORK, "render", "film.ini", "+W32", "+O" + WORK + "/link/film", "--video", "none")
says("at work on %s/out/film.mp4" % WORK, "render", "film.ini", out + "other", "--video", WORK + "/out/film.mp4")
assert os.listdir(kept + "/render") == before and os.listdir(WORK + "/out") == [], (before, os.listdir(kept + "/render"), os.listdir(WORK + "/out"))
bhfarm("render", "film.ini", "+W32", out + "other", cwd=folder) # beside it is well
open(WORK + "/go", "w").close()
assert first.wait(600) == 0, open(WORK + "/first.log").read()
for frame in (1, 2):
    same("%s/out/film%d.png" % (WORK, frame), "%s/reference/film%d.png" % (WORK, frame))
assert sorted(os.listdir(WORK + "/out")) == ["film.mp4", "film1.png", "film2.png", "other.mp4", "other1.png", "other2.png"], os.listdir(WORK + "/out")
bhfarm("render", "film.ini", "+W32", out + "film", cwd=folder) # and after it
assert os.listdir(kept + "/render") == []

# What cannot be made or written is named.
nowhere = dict(ENV, XDG_STATE_HOME="/proc/nowhere")
says("cannot make the folder /proc/nowhere/bhfarm: ", "render", "film.ini", env=nowhere)
os.makedirs(WORK + "/taken/bhfarm")
open(WORK + "/taken/bhfarm/render", "w").close()
says("cannot make the folder %s/taken/bhfarm/render/" % WORK, "render", "film.ini", env=dict(ENV, XDG_STATE_HOME=WORK + "/taken"))
assert sorted(os.listdir(folder)) == ["film.ini", "film.pov", "parts"], os.listdir(folder)

# Without HOME: as the system's list of users has it.
if FENCED:
    bare = {name: value for name, value in ENV.items() if name != "HOME"}
    for name, text in (("users", "one:x:%d:%d::%s/own:/bin/sh\n" % (os.geteuid(), os.getegid(), WORK)), ("nobody", ""), ("switch", "passwd: files\n")):
        with open(WORK + "/" + name, "w") as f:
            f.write(text)
        os.chmod(WORK + "/" + name, 0o644)

    def without_home(users):
        words = ["bwrap", "--dev-bind", "/", "/", "--bind", WORK + "/" + users, "/etc/passwd", "--bind", WORK + "/switch", "/etc/nsswitch.conf", BIN + "/bhfarm", "render", ini,
                 "--no-sandbox", "--video", "none", out + users]
        return subprocess.run(words, env=bare, capture_output=True, text=True)

    done = without_home("nobody")
    assert done.returncode == 1 and done.stderr == "bhfarm: there is no place to keep things: set HOME or XDG_STATE_HOME\n", done
    done = without_home("users")
    assert done.returncode == 0 and os.path.isdir(WORK + "/own/.local/state/bhfarm"), done
print("two at once, folders that cannot be, no HOME")
