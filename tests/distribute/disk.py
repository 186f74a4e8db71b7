# SPDX-License-Identifier: AGPL-3.0-or-later
"""Full disks: under the spool (strips, ledger, film), under a worker, and where pictures are fetched to. One clear line each, nothing lost, and on it goes when there is room
again. Then the spool cleans itself by age and size. Skipped, and says so, where no small disk may be mounted."""
import os
import shutil
import subprocess
import sys
import time

if "inside" not in sys.argv:
    for way in (["unshare", "-m"], ["unshare", "-Urm"]):
        if subprocess.run([*way, "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True).returncode == 0:
            os.execvp("unshare", [*way, sys.executable, os.path.abspath(__file__), sys.argv[1], "inside"])
    print("skipped: no disk may be mounted here")
    sys.exit(77)

from farm import BIN, ENV, PATIENCE, WORK, Gate, Server, bare, bhfarm, frames_in, same, scene, start, wait
from fault_lab import Disk

FULL = ("No space left on device", "disk is full")
FFMPEG = shutil.which("ffmpeg")
os.mkdir(WORK + "/path")
with open(WORK + "/path/ffmpeg", "w") as f: # fills the disk before it encodes, or waits, while there are files that say so
    f.write("#!/bin/bash\n[ ! -e %s/fill ] || [ \"$1\" = -version ] || { cat /dev/zero >>%s/spool-disk/filler; echo >>%s/filled; } 2>/dev/null\nwhile [ -e %s/slow ]; do sleep 0.05; done\nexec %s \"$@\"\n"
            % (WORK, WORK, WORK, WORK, FFMPEG))
os.chmod(WORK + "/path/ffmpeg", 0o755)
ENV["PATH"] = WORK + "/path:" + ENV["PATH"]
spool_disk, worker_disk, desk = Disk(WORK + "/spool-disk", 24), Disk(WORK + "/worker-disk", 16), Disk(WORK + "/desk", 8)
assert spool_disk.small and worker_disk.small and desk.small
ini = scene(WORK + "/scene", frames=4, width=200, height=100, ini="Output_File_Name=x")
gate = Gate(BIN + "/standin")
spool = spool_disk.folder + "/spool"
server = Server("--lease", "60", "--check-every", "0", spool=spool, log=WORK + "/server.log")
ENV["TMPDIR"] = worker_disk.folder
worker = start("bhfarm-worker", "--server", server.url, "--slots", "1", "--name", "it", "--nice", "0", "--cache", worker_disk.folder + "/cache", *gate.words,
               log=WORK + "/worker.log")
ENV.pop("TMPDIR")


def said(who):
    return open(WORK + "/" + who + ".log").read()


def refused(*words):
    """Words that end with one line that says why."""
    done = bhfarm(*words, server=server, good=False)
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and any(f in done.stderr for f in FULL), (words, done.returncode, done.stdout, done.stderr)
    return done.stderr


def stage(number):
    return server.job(number)["stage"]


wait(lambda: "at work" in said("worker"), "the worker", worker, WORK + "/worker.log")
# A job cannot be submitted, and nothing of it is left; with room again the same command does it.
spool_disk.fill()
refused("submit", ini, "--strips", "10")
spool_disk.empty()
number = int(bhfarm("submit", ini, "--strips", "10", server=server).stdout)
# Strips that come meanwhile wait with their worker.
gate.let(3)
wait(lambda: server.job(number)["strips_done"] == 3, "some strips", worker, WORK + "/worker.log")
watch = subprocess.Popen([BIN + "/bhfarm", "watch", "--server", server.url, str(number)], env=ENV, stderr=subprocess.PIPE, text=True)
spool_disk.fill()
gate.let(2)
wait(lambda: server.job(number)["doing"].startswith("waiting: ") and any(f in server.job(number)["doing"] for f in FULL),
     "it to say what it waits for", worker, WORK + "/server.log")
time.sleep(1) # for more tries
assert server.job(number)["strips_done"] == 3, server.job(number)
line = watch.stderr.readline()
watch.kill()
assert "waiting: " in line and any(f in line for f in FULL), line
spool_disk.empty()
gate.let(2)
wait(lambda: server.job(number)["strips_done"] == 7 and server.job(number)["doing"] == "", "it to go on", worker, WORK + "/server.log")
assert "turned away until that is mended" in said("server") and "takes what is written again" in said("server"), said("server")
# The worker's own disk: the strip goes back, blames nobody, and it says so once.
worker_disk.fill()
gate.let()
wait(lambda: "strips go back until that is mended" in said("worker"), "the worker to beg off", worker, WORK + "/worker.log")
time.sleep(1.5)
worker_disk.empty()
open(WORK + "/fill", "w").close()
gate.open()
wait(lambda: os.path.exists(WORK + "/filled"), "the film", worker, WORK + "/server.log")
assert said("worker").count("strips go back") == 1 and bhfarm("log", str(number), server=server).stdout == "", said("worker")
# The film does not fit: the job waits, says why, and makes it when there is room.
wait(lambda: "No space left" in server.job(number)["doing"], "it to say so", log=WORK + "/server.log")
assert stage(number) == "running" and "x.mp4: No space left on device" in bhfarm("status", str(number), server=server).stdout
time.sleep(3.5)
assert said("server").count("x.mp4: No space left on device; trying again") == 1, said("server")
# A server that is started meanwhile says the one line too, as often as it is started.
server.process.kill()
server.process.wait()
spool_disk.fill()
dead = subprocess.run([BIN + "/bhfarm-server", "--listen", "%s:%d" % (server.host, server.port), "--spool", spool], env=ENV, capture_output=True, text=True, timeout=PATIENCE)
assert dead.returncode == 1 and dead.stderr.count("\n") == 1 and any(f in dead.stderr for f in FULL), dead
os.remove(WORK + "/fill")
spool_disk.empty()
# Killed while it encodes: started again, it does it again, and nothing is left over.
open(WORK + "/slow", "w").close()
server.again()
wait(lambda: server.job(number)["doing"] == "encoding the film", "the film")
server.process.kill()
server.process.wait()
os.remove(WORK + "/slow")
server.again()
assert bhfarm("watch", str(number), server=server).returncode == 0
left = {f for _, _, files in os.walk(spool) for f in files} - {"lock", "url"}
assert {f for f in left if f.startswith("x")} == {"x1.png", "x2.png", "x3.png", "x4.png", "x.mp4"} and not any("part" in f or f.startswith("film.") for f in left), left
assert os.listdir(spool + "/jobs/%d" % number) == ["frames"] and os.listdir(spool + "/incoming") == []
# Fetched to a full disk, and again.
desk.fill()
assert "cannot write " + desk.folder in refused("fetch", str(number), "--to", desk.folder)
assert os.listdir(desk.folder) == ["filler"], os.listdir(desk.folder)
desk.empty()
assert len(bhfarm("fetch", str(number), "--to", desk.folder, server=server).stdout.split()) == 5
for frame in range(1, 5):
    bare(WORK + "/bare.png", 200, 100, frame)
    same(desk.folder + "/x%d.png" % frame, WORK + "/bare.png")
assert frames_in(desk.folder + "/x.mp4") == 4


def restarted(*words):
    server.process.terminate()
    assert server.process.wait(PATIENCE) == 0
    server.words = ("--lease", "60", "--check-every", "0", *words)
    server.again()


# The spool by size: the oldest job that has ended goes, the youngest stays; then by age, with the scene's files a day after.
second = int(bhfarm("submit", ini, "--strips", "4", "--frames", "2-3", server=server).stdout)
bhfarm("watch", str(second), server=server)
server.process.terminate() # then no ledger's journal counts, which comes and goes
assert server.process.wait(PATIENCE) == 0


def bytes_in(place):
    return sum(os.path.getsize(os.path.join(top, f)) for top, _, files in os.walk(place) for f in files)


restarted("--keep-gb", "%.6f" % ((bytes_in(spool) - bytes_in(spool + "/jobs/%d" % number) / 2) / 1e9))
wait(lambda: [j["id"] for j in server.ask("/v1/jobs")[1]["jobs"]] == [second], "the older job to go")
assert os.listdir(spool + "/jobs") == [str(second)]
assert len(os.listdir(spool + "/bundles")) == 1
for top, _, files in os.walk(spool):
    for f in files:
        if "/bundles" in top or "/files" in top:
            os.utime(os.path.join(top, f), (1e9, 1e9))
restarted("--keep-days", "0")
wait(lambda: server.ask("/v1/jobs")[1]["jobs"] == [] and os.listdir(spool + "/bundles") == [], "all to go")
assert os.listdir(spool + "/jobs") == [] and not any(files for _, _, files in os.walk(spool + "/files")), "files are left"
print("full disks: one line each, and on it went; the spool cleans itself")
