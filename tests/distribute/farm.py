# SPDX-License-Identifier: AGPL-3.0-or-later
"""The farm's programs as a test runs them: in a folder and a home of their own, ended with the test."""
import atexit
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

sys.path.append(os.path.dirname(os.path.abspath(__file__)) + "/../overlay")
import pictures # noqa: E402
from povray import patiently # noqa: E402

BIN = os.path.abspath(sys.argv[1])
os.environ["no_proxy"] = os.environ["NO_PROXY"] = "*" # nothing here is for the world outside
os.umask(0o077) # tokens are secret, or there would be a word about it
WORK = tempfile.mkdtemp(prefix="farm-test-")
ENV = dict(os.environ, HOME=WORK + "/home")
for name in ("BHFARM_SERVER", "BHFARM_TOKEN_FILE", "BHFARM_CA", "POVINI", "XDG_STATE_HOME", "XDG_CACHE_HOME"):
    ENV.pop(name, None)
running = []
# Some containers let nobody make namespaces.
FENCED = subprocess.run(["bwrap", "--unshare-all", "--ro-bind", "/", "/", "true"], capture_output=True).returncode == 0


def clean():
    for p in running:
        if p.poll() is None:
            p.kill()
            p.wait()
    shutil.rmtree(WORK, ignore_errors=True)


atexit.register(clean)

PATIENCE = 600 # seconds: what hangs comes to that, and no machine that is merely slow or busy
# The loopback has 16 million addresses. On one of our own no other test takes our port while a server starts over.
HERE = "127.%d.%d.%d" % (64 + (os.getpid() >> 16) % 64, os.getpid() >> 8 & 255, os.getpid() & 255)

SCENE = """#version 3.7;
global_settings { assumed_gamma 1 }
#include "colors.inc"
#include "parts/sky.inc"
camera { location <0, 2 + 2*clock, -14> look_at 0 angle 40 }
blackhole { 0, 1 effect_radius 20 tolerance 1e-2 }
plane { y, -3 pigment { checker Red Blue } }
sphere { <3, 0, 2>, 1 pigment { Green } finish { reflection 0.5 } }
light_source { <10, 20, -20> White }
"""
SKY = "sky_sphere { pigment { granite color_map { [0 rgb 0] [1 rgb 1] } } }\n"


def scene(folder, frames=2, width=100, height=150, extra="", ini=""):
    """A small film of a black hole: film.ini, film.pov and an include in a folder. Returns the .ini."""
    os.makedirs(folder + "/parts", exist_ok=True)
    for name, text in (("film.pov", SCENE + extra), ("parts/sky.inc", SKY)):
        with open(folder + "/" + name, "w") as f:
            f.write(text)
    with open(folder + "/film.ini", "w") as f:
        f.write("Input_File_Name=film.pov\nInitial_Frame=1\nFinal_Frame=%d\nWidth=%d\nHeight=%d\nBits_Per_Color=16\nAntialias=On\n%s\n"
                % (frames, width, height, ini))
    return folder + "/film.ini"


def include_folder():
    """POV-Ray's own includes in the build tree, by which the reference finds colors.inc."""
    return os.path.normpath(BIN + "/../../upstream/tree/distribution/include")


def povray(ini, folder, *words):
    """One povray, whole frames: the reference."""
    empty = WORK + "/empty.ini"
    with open(empty, "w") as f:
        f.write("Verbose=Off\n")
    words = [BIN + "/povray", ini, "+L" + include_folder(), "-D", "+WT2", "Reproducible=on", *words]
    done = patiently(lambda: subprocess.run(words, cwd=folder, capture_output=True, text=True, env=dict(ENV, POVINI=empty)), lambda run: run.stderr)
    assert done.returncode == 0, done.stderr[-2000:]


def pixels(name):
    """Width, height, depth, colour type and the bytes of a PNG's rows."""
    with open(name, "rb") as f:
        head, _, rows = pictures.unpacked_png(f.read())
    return head, rows


def same(a, b):
    """That two pictures have the same pixels; says how many differ."""
    (ha, pa), (hb, pb) = pixels(a), pixels(b)
    assert ha == hb, "%s is %s, %s is %s" % (a, ha, b, hb)
    differ = sum(x != y for x, y in zip(pa, pb))
    assert differ == 0, "%d of %d bytes differ between %s and %s" % (differ, len(pa), a, b)


class Gate:
    """A povray that begins a strip only when it is let. So a test finds a job as far as it wants it, however fast or slow the machine is.
    Being a script it does without a fence. `program` is what renders."""
    def __init__(self, program=BIN + "/povray"):
        self.folder = tempfile.mkdtemp(dir=WORK)
        self.povray, self.number = self.folder + "/povray", 0
        # Who takes a file away may go on; one file is for all.
        with open(self.povray, "w") as f:
            f.write("""#!/bin/bash
case "$POVINI" in */strip.ini)
    until [ -e %s/open ]; do
        for one in %s/let-*; do mv "$one" %s/taken-$$ 2>/dev/null && break 2; done
        [ -d %s ] || exit 1
        sleep 0.02
    done ;;
esac
exec %s "$@"
""" % (*[self.folder] * 4, program))
        os.chmod(self.povray, 0o700)
        self.words = ["--no-sandbox", "--povray", self.povray]

    def let(self, strips=1):
        for _ in range(strips):
            self.number += 1
            open("%s/let-%d" % (self.folder, self.number), "w").close()

    def open(self):
        open(self.folder + "/open", "w").close()

    def shut(self):
        os.remove(self.folder + "/open")


def start(program, *words, log):
    p = subprocess.Popen([BIN + "/" + program, *words], env=ENV, stdout=open(log, "a"), stderr=subprocess.STDOUT, start_new_session=True)
    running.append(p)
    return p


class Server:
    """bhfarm-server on a free port of the loopback; `again` starts it over on the same port and spool. Certificates are for 127.0.0.1."""
    def __init__(self, *words, spool=None, log=None):
        self.spool = spool or tempfile.mkdtemp(dir=WORK)
        self.words, self.port, self.host = words, 0, "127.0.0.1" if "--tls-cert" in words else HERE
        self.log = log or self.spool + ".log"
        self.again()

    def again(self):
        file = self.spool + "/url"
        if os.path.exists(file):
            os.remove(file)
        self.process = start("bhfarm-server", "--listen", "%s:%d" % (self.host, self.port), "--spool", self.spool, *self.words, log=self.log)
        wait(lambda: os.path.exists(file) and open(file).read().strip(), "the server to start", self.process, self.log)
        self.url = open(file).read().strip()
        self.port = int(self.url.rsplit(":", 1)[1])

    def worker(self, *words, name="worker"):
        return start("bhfarm-worker", "--server", self.url, "--slots", "1", "--name", name, "--nice", "0", "--cache",
                     WORK + "/cache-" + name, *([] if FENCED or "--no-sandbox" in words else ["--no-sandbox"]), *words, log=WORK + "/" + name + ".log")

    def ask(self, path, body=None, method=None, token=None, raw=None):
        """Status and JSON (or bytes) of an answer."""
        data = raw if raw is not None else json.dumps(body).encode() if body is not None else None
        request = urllib.request.Request(self.url + path, data=data, method=method)
        if token:
            request.add_header("Authorization", "Bearer " + token)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
                status, got = answer.status, answer.read()
        except urllib.error.HTTPError as e:
            status, got = e.code, e.read()
        try:
            return status, json.loads(got) if got else None
        except ValueError:
            return status, got

    def job(self, number):
        return self.ask("/v1/jobs/%d" % number)[1]


def bhfarm(*words, server=None, cwd=None, good=True):
    if server:
        words = (words[0], "--server", server.url, *words[1:])
    done = subprocess.run([BIN + "/bhfarm", *words], env=ENV, cwd=cwd, capture_output=True, text=True)
    assert not good or done.returncode == 0, "bhfarm %s: %s" % (" ".join(words), done.stderr)
    return done


def new_token(name="token"):
    """A token, in a file of that name too."""
    token = bhfarm("token", "new").stdout.strip()
    with open(WORK + "/" + name, "w") as f:
        f.write(token + "\n")
    return token


def bare(to, width, height, frame, program=BIN + "/standin"):
    """A frame as the stand-in makes it without a farm."""
    ini = WORK + "/bare.ini"
    with open(ini, "w") as f:
        f.write("Width=%d\nHeight=%d\nSubset_Start_Frame=%d\nOutput_File_Name=%s\n" % (width, height, frame, to))
    subprocess.run([program], env=dict(ENV, POVINI=ini), check=True)


def frames_in(film):
    """How many there are by ffprobe's count."""
    done = subprocess.run(["ffprobe", "-v", "error", "-count_packets", "-select_streams", "v", "-show_entries", "stream=nb_read_packets", "-of", "csv=p=0", film],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return int(done.stdout)


def wait(condition, what, process=None, log=None, seconds=PATIENCE):
    until = time.monotonic() + seconds
    while not condition():
        if process and process.poll() is not None or time.monotonic() > until:
            sys.exit("waited in vain for %s\n%s" % (what, open(log).read()[-3000:] if log else ""))
        time.sleep(0.05)
