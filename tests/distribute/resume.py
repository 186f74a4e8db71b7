# SPDX-License-Identifier: AGPL-3.0-or-later
"""bhfarm render: a film on one machine; Ctrl-C and the same command goes on where it was; bad input gets one line and leaves nothing."""
import os
import pty
import signal
import subprocess
import time

from farm import BIN, ENV, PATIENCE, WORK, Gate, bhfarm, povray, same, scene, wait

folder = WORK + "/scene"
ini = scene(folder, frames=3)
os.makedirs(WORK + "/reference")
povray(ini, folder, "+O" + WORK + "/reference/film")
state = ENV["HOME"] + "/.local/state/bhfarm/render"

gate = Gate()
gate.let(3)
process = subprocess.Popen([BIN + "/bhfarm", "render", "film.ini", "--slots", "1", "--strips", "5", *gate.words], cwd=folder, env=ENV, stderr=subprocess.PIPE, text=True)


def settled(but=None):
    for job in os.listdir(state) if os.path.isdir(state) else []:
        if job == but:
            continue
        strips = state + "/" + job + "/spool/jobs/1/strips"
        if os.path.isdir(strips) and len(os.listdir(strips)) >= 3:
            return True
    return False


wait(settled, "three strips", process)
process.send_signal(signal.SIGINT)
said = process.communicate(timeout=PATIENCE)[1]
assert process.returncode == 130 and "the same command goes on" in said, (process.returncode, said)
assert not os.path.exists(folder + "/film3.png") # those that are finished are there
done = bhfarm("render", "film.ini", "--slots", "1", "--strips", "5", cwd=folder)
assert "going on where it was" in done.stderr, done.stderr
assert [os.path.basename(f) for f in done.stdout.split()] == ["film1.png", "film2.png", "film3.png", "film.mp4"], done.stdout
for frame in (1, 2, 3):
    same("%s/film%d.png" % (folder, frame), "%s/reference/film%d.png" % (WORK, frame))
assert os.listdir(state) == [], "left behind: %s" % os.listdir(state)
probe = subprocess.run(["ffmpeg", "-i", folder + "/film.mp4", "-f", "null", "-"], capture_output=True, text=True).stderr
assert "h264" in probe and "100x150" in probe and "frame=    3" in probe, probe

# Server and worker killed (-9) under its hands: it starts them again.
gate = Gate()
gate.let(3)
process = subprocess.Popen([BIN + "/bhfarm", "render", "film.ini", "--strips", "5", "--video", "none", "+O" + WORK + "/killed", *gate.words], cwd=folder, env=ENV)
wait(settled, "three strips", process)


def children():
    return open("/proc/%d/task/%d/children" % (process.pid, process.pid)).read().split()


both = children()
assert len(both) == 2, both
for child in both:
    os.kill(int(child), signal.SIGKILL)
    wait(lambda: len(children()) == 2 and child not in children(), "another instead of the one that was killed", process)
gate.open()
assert process.wait(PATIENCE) == 0
for frame in (1, 2, 3):
    same("%s/killed%d.png" % (WORK, frame), "%s/reference/film%d.png" % (WORK, frame))

# Stopped, and the scene edited: nothing of the old one is in the film, nor left behind. What nobody went on with for a month goes too.
def interrupted(words, but=None):
    gate = Gate()
    gate.let(3)
    process = subprocess.Popen([BIN + "/bhfarm", "render", "film.ini", "--slots", "1", *words, *gate.words], cwd=folder, env=ENV, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    wait(lambda: settled(but), "three strips", process)
    process.send_signal(signal.SIGINT)
    assert process.wait(PATIENCE) == 130


interrupted(["--strips", "6", "--video", "none", "+O" + WORK + "/old"])
old, = os.listdir(state)
os.utime(state + "/" + old + "/token", (time.time() - 31 * 86400,) * 2)
words = ["--strips", "5", "--video", "none", "+O" + WORK + "/edited"]
interrupted(words, old)
assert old not in os.listdir(state)
before = open(folder + "/film.pov").read()
with open(folder + "/film.pov", "w") as f:
    f.write(before.replace("Green", "Blue"))
povray(ini, folder, "+O" + WORK + "/reference/blue")
done = bhfarm("render", "film.ini", "--slots", "1", *words, cwd=folder)
assert "going on" not in done.stderr, done.stderr
for frame in (1, 2, 3):
    same("%s/edited%d.png" % (WORK, frame), "%s/reference/blue%d.png" % (WORK, frame))
assert os.listdir(state) == [], "left behind: %s" % os.listdir(state)
with open(folder + "/film.pov", "w") as f:
    f.write(before)

# On a terminal there is progress, on one line that is written over; elsewhere there was none.
shown, terminal, gate = b"", pty.openpty(), Gate()
gate.let(14)
process = subprocess.Popen([BIN + "/bhfarm", "render", "film.ini", "--strips", "5", "--video", "none", "+O" + WORK + "/again", *gate.words], cwd=folder, env=ENV, stdout=subprocess.DEVNULL,
                           stderr=terminal[1])
os.close(terminal[1])
while True:
    try:
        shown += os.read(terminal[0], 1000)
    except OSError: # the terminal's other end is closed
        break
    if b"to go" in shown and not os.path.exists(gate.folder + "/open"):
        gate.open()
assert process.wait() == 0 and b"/15 strips" in shown and b"/3 frames" in shown and b"to go" in shown and b"parsing the scene" in shown and b"rendering a small frame" in shown and b"\n" not in shown.strip(), shown
same(WORK + "/again2.png", WORK + "/reference/film2.png")
assert "strips" not in done.stderr.replace(done.stderr.split("\n")[0], ""), done.stderr


def says(words, text):
    """One line that holds the text, and a code that is not zero."""
    bad = bhfarm("render", *words, cwd=folder, good=False)
    lines = bad.stderr.strip().split("\n")
    assert bad.returncode != 0 and len(lines) == 1 and text in lines[0], (words, bad.returncode, bad.stderr)


says(["nosuch.pov"], "there is no scene nosuch.pov")
says(["film.ini", "--frames", "3-2"], "the last of --frames is '2'")
says(["film.ini", "--strips", "151"], "a frame has 150 rows")
says(["film.ini", "Final_Frame=0"], "Final_Frame is 0, below Initial_Frame 1")
says(["film.ini", "+SR10"], "Start_Row does not work in a farm")
says(["film.ini", "+FT"], "Output_File_Type is 'T'")
says(["film.ini", "--nonsense"], "no option --nonsense")
says(["film.ini", "+O/nosuch/x"], "there is no folder /nosuch")
with open(folder + "/parts/sky.inc", "w") as f:
    f.write('#include "missing.inc"\n')
says(["film.ini"], "Cannot open include file missing.inc")
assert os.listdir(state) == []
print("stopped, went on, the same pixels; bad input is told")
