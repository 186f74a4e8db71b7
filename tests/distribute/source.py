# SPDX-License-Identifier: AGPL-3.0-or-later
"""bhfarm source: the very files that were built, nothing of POV-Ray's, and they configure elsewhere."""
import hashlib
import os
import subprocess
import tarfile

from farm import BIN, ENV, WORK, Server

root = os.path.normpath(os.path.dirname(os.path.abspath(__file__)) + "/../..")
upstream = os.path.normpath(BIN + "/../../upstream/pristine")


def fetch(to, *words):
    with open(to, "wb") as f:
        done = subprocess.run([BIN + "/bhfarm", "source", *words], env=ENV, stdout=f, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, done.stderr
    return open(to, "rb").read()


def sha(name):
    return hashlib.sha256(open(name, "rb").read()).hexdigest()


# Of this installation, and of a server elsewhere: the same here.
own = fetch(WORK + "/own.tar.gz")
server = Server()
assert fetch(WORK + "/server.tar.gz", "--server", server.url) == own
with tarfile.open(WORK + "/own.tar.gz") as archive:
    assert all(m.isfile() and m.name.startswith("povray-blackhole/") and ".." not in m.name for m in archive.getmembers())
    archive.extractall(WORK + "/out")
tree = WORK + "/out/povray-blackhole"
there = {os.path.relpath(os.path.join(d, f), tree) for d, _, files in os.walk(tree) for f in files}
if os.path.exists(root + "/.git"): # else it is unpacked from such an archive itself
    known = subprocess.run(["git", "-c", "safe.directory=*", "ls-files"], cwd=root, capture_output=True, text=True, check=True).stdout.split("\n")
    missing = {f for f in known if f and os.path.exists(root + "/" + f)} - there
    assert not missing, missing
for name in there - {"SOURCE"}:
    assert sha(tree + "/" + name) == sha(root + "/" + name), name + " is another than what was built; build again?"
    assert os.access(tree + "/" + name, os.X_OK) == os.access(root + "/" + name, os.X_OK), name

# Nothing of POV-Ray's but the licence's text; and where that comes from.
theirs = {sha(os.path.join(d, f)): f for d, _, files in os.walk(upstream) for f in files if os.path.getsize(os.path.join(d, f)) > 0}
assert len(theirs) > 1000
same = {name for name in there if sha(tree + "/" + name) in theirs}
assert same <= {"LICENSE"}, same
note = open(tree + "/SOURCE").read()
for part in ("dsc", "orig.tar.gz", "debian.tar.xz"):
    line, = [l for l in note.split("\n") if l.endswith(part) and "povray_3.7" in l]
    assert line in open(root + "/tools/upstream").read() and len(line.split()[0]) == 64

# What comes out is enough: it configures, given POV-Ray's source, and packs the same files again.
done = subprocess.run(["cmake", "-S", tree, "-B", WORK + "/build", "-DPOVRAY_SOURCE=" + upstream], capture_output=True, text=True)
assert done.returncode == 0, done.stderr[-2000:]
for f in ("distribute", "source", "unix"):
    assert os.path.isdir("%s/build/%s" % (WORK, f))
again = subprocess.run([tree + "/tools/source", "--list"], capture_output=True, text=True, check=True).stdout.split()
assert set(again) == there - {"SOURCE"}, set(again) ^ there
nowhere = subprocess.run([BIN + "/bhfarm", "source", "--server", "http://127.0.0.1:1"], env=ENV, capture_output=True, text=True)
assert nowhere.returncode == 1 and nowhere.stdout == "" and nowhere.stderr.count("\n") == 1, nowhere
print("%d files, %d bytes packed" % (len(there), len(own)))
