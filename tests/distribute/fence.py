# SPDX-License-Identifier: AGPL-3.0-or-later
"""Hostile scenes sent by hand, past bhfarm's own checks: none reads, writes or runs what is not its own, nor outlives its limits, and the submitter is told which.
Each deed is then done without the fence, where it succeeds: the scenes try in earnest."""
import http.server
import itertools
import json
import os
import queue
import re
import socket
import subprocess
import sys
import threading
import time

from farm import BIN, ENV, FENCED, PATIENCE, WORK, Server, bhfarm, include_folder, patiently, start, wait
from hand import JOB, bundle_of, sha

if not FENCED:
    print("bubblewrap does not work here")
    sys.exit(77)
HEAD = "#version 3.7; global_settings { assumed_gamma 1 }\ncamera { location -5*z look_at 0 }\nlight_source { -9*z rgb 1 }\nsphere { 0, 1 pigment { rgb 1 } }\n"
SECRET, TARGET = WORK + "/home/secret", WORK + "/target"
for name in (SECRET, TARGET):
    os.makedirs(name)


def put(name, text):
    with open(name, "w") as f:
        f.write(text)


put(SECRET + "/s.txt", '"LEAK-4711",\n')
put(SECRET + "/s.inc", '#error "LEAK-4711"\n')
put(SECRET + "/s.pov", HEAD)
put(SECRET + "/s.ini", "Declare=LEAK=4711\n")
with open(SECRET + "/s.df3", "wb") as f:
    f.write(bytes([0, 1, 0, 1, 0, 1, 99]))
with open(include_folder() + "/timrom.ttf", "rb") as f, open(SECRET + "/s.ttf", "wb") as g:
    g.write(f.read())
put(WORK + "/none.ini", "Verbose=Off\n")
kinds = {"png": "N", "tga": "T", "ppm": "P", "jpeg": "J", "hdr": "H", "exr": "E"}
for kind, letter in kinds.items():
    words = [BIN + "/povray", "+I" + SECRET + "/s.pov", "+F" + letter, "+O%s/s.%s" % (SECRET, kind), "+W8", "+H8", "-D"]
    done = patiently(lambda: subprocess.run(words, env=dict(ENV, POVINI=WORK + "/none.ini"), capture_output=True, text=True), lambda run: run.stderr)
    assert done.returncode == 0, done.stderr
listener = socket.create_server(("127.0.0.1", 0))
URL = "http://127.0.0.1:%d/x" % listener.getsockname()[1]

POLL = 0.5 # seconds that a worker is kept waiting for a strip


class Desk(http.server.BaseHTTPRequestHandler):
    """A server that lends what a test puts in `tasks` and keeps what comes back in `results`: no second tries, no pauses."""
    protocol_version = "HTTP/1.1"
    tasks, results, limited, bundles, files = queue.Queue(), {}, {}, {}, {}
    known, left = set(), set() # workers by their ids; those that have left may still have asked

    def log_message(self, *_):
        pass

    def reply(self, body=None, raw=None):
        data = raw if raw is not None else json.dumps(body).encode() if body is not None else b""
        self.send_response(200 if data else 204)
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def do_GET(self):
        name = self.path.rsplit("/", 1)[1]
        if "/bundles/" in self.path:
            self.reply(self.bundles[name])
        else:
            self.reply(raw=self.files[name])

    def do_POST(self):
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        if self.path == "/v1/workers":
            self.known.add(json.loads(body)["id"])
            self.reply({"protocol": 1, "lease_seconds": 20})
        elif self.path.endswith("/take"):
            who = self.path.split("/")[3]
            try:
                task = self.tasks.get(timeout=0 if who in self.left else POLL)
            except queue.Empty:
                return self.reply()
            if who not in self.left:
                return self.reply(task)
            self.tasks.put(task)
            self.reply()
        elif self.path.endswith("/heartbeat"):
            self.reply({"drop": [], "draining": False})
        else:
            if "/leases/" in self.path:
                said = json.loads(body) if self.path.endswith("/failure") else {}
                lease = int(self.path.split("/")[3])
                self.limited[lease] = said.get("limited", False)
                self.results[lease] = (self.path.rsplit("/", 1)[1].split("?")[0], said.get("line", ""), said.get("log", ""))
            self.reply({"accepted": True, "why": ""})

    do_PUT = do_DELETE = do_POST


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Desk)
server.daemon_threads = True
server.handle_error = lambda *_: None  # a worker that leaves hangs up
threading.Thread(target=server.serve_forever, daemon=True).start()
URL_OF_SERVER = "http://127.0.0.1:%d" % server.server_address[1]
leases = itertools.count(1)


def send(text, options=(), files=()):
    """A strip as no bhfarm would send it; its lease and the bundle's name."""
    contents = {name: content.encode() for name, content in dict(files, **{"scene.pov": text}).items()}
    Desk.files.update((sha(data), data) for data in contents.values())
    bundle, name = bundle_of(contents)
    Desk.bundles[name] = bundle
    options = list(options)
    if not any(o.startswith("Input_File_Name") for o in options):
        options.append("Input_File_Name=scene.pov")
    lease = next(leases)
    spec = dict(JOB, bundle=name, options=options, width=16, height=12, animation=False, first=0, last=0, digits=0, strip_rows=12)
    Desk.tasks.put({"lease": lease, "job": 1, "frame": 0, "row": 0, "rows": 12, "spec": spec})
    return lease, name


def outcome(lease):
    """strip, failure or return; the error's line; the end of what povray printed."""
    wait(lambda: lease in Desk.results, "lease %d" % lease, None, worker_log)
    assert Desk.limited[lease] == ("-limit allows" in Desk.results[lease][1]), Desk.results[lease] # whom to blame
    return Desk.results[lease]


def worker(name, *words):
    global worker_log
    worker_log = WORK + "/" + name + ".log"
    return start("bhfarm-worker", "--server", URL_OF_SERVER, "--slots", "2", "--name", name, "--cache", WORK + "/cache", *words, log=worker_log)


def leave(process):
    process.terminate()
    assert process.wait(PATIENCE) == 0
    Desk.left |= Desk.known # they asked for strips until then, and hear no answer: a strip would be lost


# Somebody else's job, whose files lie in the same worker's cache.
fenced = worker("fenced", "--memory-limit", "2048")
other, other_bundle = send(HEAD, files={"other.inc": '#error "LEAK-4711"\n'})
assert outcome(other)[0] == "strip", outcome(other)
OTHER = WORK + "/cache/bundles/" + other_bundle
assert os.path.exists(OTHER + "/other.inc")
IMAGE = "plane { z, 2 pigment { image_map { %s \"%s\" } } }\n"
reading = {
    "#fopen": ['#fopen F "%s/s.txt" read\n#read (F, A)\n#error A\n' % SECRET],
    "#fopen /etc/passwd": ['#fopen F "/etc/passwd" read\n#error "LEAK-4711"\n'],
    "#fopen above": ['#fopen F "%s/s.txt" read\n#error "LEAK-4711"\n' % ("../" * 12 + SECRET[1:])],
    "#include": ['#include "%s/s.inc"\n' % SECRET],
    "#include of another's": ['#include "%s/other.inc"\n' % OTHER],
    "file_exists": ['#if (file_exists("%s/s.inc")) #error "LEAK-4711" #end\n#error "cannot find it"\n' % SECRET],
    "the environment": ['#fopen F "/proc/self/environ" read\n#error "LEAK-4711"\n'],
    "the machine": ['#fopen F "/proc/cpuinfo" read\n#error "LEAK-4711"\n'],
    "Library_Path": ['#include "s.inc"\n', ["Library_Path=" + SECRET]],
    "height_field": ['height_field { png "%s/s.png" }\n' % SECRET],
    "density_file": ['sphere { 0, 2 hollow pigment { rgbt 1 } interior { media { emission 1 density { density_file df3 "%s/s.df3" } } } }\n' % SECRET],
    "text": ['text { ttf "%s/s.ttf" "x" 1, 0 pigment { rgb 1 } }\n' % SECRET],
    "bump_map": ['plane { z, 2 pigment { rgb 1 } normal { bump_map { png "%s/s.png" } } }\n' % SECRET],
    "image_pattern": ['plane { z, 2 pigment { image_pattern { png "%s/s.png" } } }\n' % SECRET],
    "Input_File_Name": ["", ["Input_File_Name=%s/s.pov" % SECRET]],
}
for kind in kinds:
    reading["image_map " + kind] = [IMAGE % (kind, SECRET + "/s." + kind)]
sent = {what: send(HEAD + way[0], *way[1:])[0] for what, way in reading.items()}
net = [send(HEAD + '#include "%s.inc"\n' % URL)[0], send(HEAD + IMAGE % ("png", URL + ".png"))[0]]
for what, number in sent.items():
    stage, error, log = outcome(number)
    assert stage == "failure" and re.search("annot (open|find)|ould not find|not found", error + log) and "LEAK-4711" not in error + log, (what, stage, error, log[-500:])
for number in net:
    assert outcome(number)[0] == "failure", number

# Writing. Where a scene runs it may write: it reads that again, and it is gone afterwards.
RADIOSITY = HEAD.replace("assumed_gamma 1", "assumed_gamma 1 radiosity { count 5 }")
WRITE = '#fopen F "%s" %s\n#write (F, "x")\n#fclose F\n'
put(TARGET + "/there", "as it was")
up = os.path.relpath(TARGET, "/tmp/a/b/c")
writing = {
    "absolute": [HEAD + WRITE % (TARGET + "/absolute", "write")],
    "relative": [HEAD + WRITE % (up + "/relative", "write")],
    "append": [HEAD + WRITE % (TARGET + "/there", "append")],
    "overwrite another's": [HEAD + WRITE % (OTHER + "/new.inc", "write")],
    "photons": [HEAD.replace("assumed_gamma 1", 'assumed_gamma 1 photons { count 20 save_file "%s/photons" }' % TARGET) +
                "sphere { <0, 0, -3>, 0.5 pigment { rgbt 1 } interior { ior 1.5 } photons { target refraction on } }\n"],
    "Post_Frame_Command": [HEAD, ['Post_Frame_Command=\"touch %s/command\"' % TARGET]],
    "Pre_Scene_Command": [HEAD, ['Pre_Scene_Command=\"touch %s/before\"' % TARGET]],
    "Fatal_Error_Command": [HEAD + '#error "on purpose"\n', ['Fatal_Error_Command=\"touch %s/fatal\"' % TARGET]],
    "Create_Ini": [HEAD, ["Create_Ini=%s/ini" % TARGET]],
    "Ray_Paths": [HEAD + "blackhole { <0, 0, 3>, 0.1 }\n", ["Ray_Paths=%s/rays.csv" % TARGET]],
    "Radiosity_File_Name": [RADIOSITY, ["Radiosity_File_Name=%s/radiosity" % TARGET, "Radiosity_To_File=On"]],
    "Output_File_Name": [HEAD, ["Output_File_Name=%s/picture" % TARGET]],
    "a section that swallows the rest": [HEAD, ["Include_Ini=section.ini"], {"section.ini": "Output_File_Name=%s/section\n[x]\n" % TARGET}],
}
for stream in ("All", "Debug", "Fatal", "Render", "Statistic", "Warning"):
    writing[stream + "_File"] = [HEAD, ["%s_File=%s/%s" % (stream, TARGET, stream)]]
sent = {what: send(*way)[0] for what, way in writing.items()}
own = send(HEAD + '#fopen F "made.inc" write\n#write (F, "#declare Y = 5;")\n#fclose F\n#include "made.inc"\n#if (Y != 5) #error "lost" #end\n#fopen G "sub/x" write\n',
           files={"sub/y.inc": ""})[0]
beside = [send(HEAD + WRITE % ("../" + place + "a.png", "write"))[0] for place in ("", "out/", "../")]
for what, number in sent.items():
    outcome(number)
    assert os.listdir(TARGET) == ["there"] and open(TARGET + "/there").read() == "as it was", (what, os.listdir(TARGET))
assert sorted(os.listdir(OTHER)) == ["other.inc", "scene.pov"], os.listdir(OTHER)
assert outcome(own)[0] == "strip", outcome(own)
for number in beside:
    assert outcome(number)[0] == "failure" and "Cannot open user file ../" in outcome(number)[1], outcome(number)
leave(fenced)

# Limits.
BOMBS = {
    "#declare I = 0; #while (1) #declare I = I + 1; #end\n": "--cpu-limit allows, 2 s",
    "#declare I = 0; #while (1) #declare I = I + 1; sphere { I, 1 pigment { granite color_map { [0 rgb 0] [1 rgb 1] } } } #end\n": "--memory-limit allows, 600 MB",
    "#declare A = array[20000][20000];\n": "--memory-limit allows, 600 MB",
    '#fopen F "x" write #while (1) #write (F, "0123456789012345678901234567890123456789") #end\n': "--output-limit allows, 8 MB",
    '#while (1) #debug "0123456789012345678901234567890123456789012345678901234567890123456789\\n" #end\n': "--output-limit allows, 8 MB",
    '#declare I = 0; #while (1) #declare I = I + 1; #fopen F concat("f", str(I, 0, 0)) write #fclose F #end\n': "--output-limit allows, 8 MB",
}
# A busy machine writes little in two seconds: only the first, which does nothing else, may meet that limit.
for name, seconds, bombs in (("short", "2", list(BOMBS.items())[:1]), ("limited", "60", list(BOMBS.items())[1:])):
    limited = worker(name, "--cpu-limit", seconds, "--memory-limit", "600", "--output-limit", "8")
    for text, line in bombs:
        stage, error, log = outcome(send(HEAD + text)[0])
        assert stage == "failure" and line in error and "\n" not in error, (text, stage, error, log[-300:])
        assert len(log) <= 40000
    assert outcome(send(HEAD)[0])[0] == "strip"
    leave(limited)
slow = worker("slow", "--wall-limit", "2", "--cpu-limit", "0")
stage, error, log = outcome(send(HEAD + "#while (1) #end\n")[0])
assert stage == "failure" and "--wall-limit allows, 2 s" in error, error
leave(slow)
# One that hangs: after its version and its test picture this one only sleeps.
put(WORK + "/hangs", '#!/bin/bash\n[ "$1" = --version ] || grep -q probe "$POVINI" || exec sleep 1000\nexec %s/povray "$@"\n' % BIN)
os.chmod(WORK + "/hangs", 0o755)
hung = worker("hung", "--no-sandbox", "--povray", WORK + "/hangs", "--hang-limit", "2")
stage, error, log = outcome(send(HEAD)[0])
assert stage == "failure" and error == "the render did nothing for longer than --hang-limit allows, 2 s", error
leave(hung)

# Without the fence all of it works, but for what POV-Ray itself cannot do and what the farm says last.
free = worker("free", "--no-sandbox")
for what, number in {what: send(HEAD + way[0], *way[1:])[0] for what, way in reading.items()}.items():
    stage, error, log = outcome(number)
    assert stage == "strip" or "LEAK-4711" in error + log, (what, error, log[-300:])
for number in [send(*way)[0] for way in writing.values()]:
    outcome(number)
made = set(os.listdir(TARGET))
leave(free)
assert made >= {"absolute", "relative", "photons", "ini", "rays.csv", "radiosity"}, made
assert open(TARGET + "/there").read() != "as it was" and os.path.exists(OTHER + "/new.inc")
listener.settimeout(0)
try:
    listener.accept()
    sys.exit("a scene has reached the network")
except BlockingIOError:
    pass

# Where there is no bubblewrap, or none that works.
for name, text in (("missing", None), ("broken", "#!/bin/bash\necho 'bwrap: No permissions to create new namespace' >&2\nexit 1\n")):
    folder = WORK + "/" + name
    os.makedirs(folder)
    for tool in ("bash", "ldd"):
        os.symlink("/usr/bin/" + tool, folder + "/" + tool)
    if text:
        put(folder + "/bwrap", text)
        os.chmod(folder + "/bwrap", 0o755)
    there = dict(ENV, PATH=folder)
    done = subprocess.run([BIN + "/bhfarm-worker", "--server", URL_OF_SERVER], env=there, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "--no-sandbox" in done.stderr and "bubblewrap" in done.stderr, done.stderr
    for words, said in (([], 1), (["--no-sandbox"], 0)):
        put(WORK + "/own.pov", HEAD)
        done = subprocess.run([BIN + "/bhfarm", "render", "own.pov", "+W16", "+H12", *words], env=there, cwd=WORK, capture_output=True, text=True, timeout=PATIENCE)
        assert done.returncode == 0 and done.stderr.count("\n") == said and done.stderr.count("without a fence") == said, done.stderr
# One's own scene, tried out: it reads what its owner reads, and changes nothing.
put(WORK + "/own.pov", HEAD + '#fopen F "made.inc" write\n#write (F, "#declare Y = 5;")\n#fclose F\n#include "made.inc"\n#include "home/secret/s.inc"\n')
put(SECRET + "/s.inc", "#declare Z = 1;\n")
farm = Server()
before = sorted(os.listdir(WORK))
bhfarm("submit", "own.pov", "+W16", "+H12", server=farm, cwd=WORK)
assert sorted(os.listdir(WORK)) == before
bad = bhfarm("submit", "own.pov", "Post_Scene_Command=touch x", server=farm, cwd=WORK, good=False)
assert bad.returncode == 1 and "Post_Scene_Command does not work in a farm" in bad.stderr, bad.stderr
# What a limit says reaches the submitter, in one line; only the second of five frames never ends.
put(WORK + "/own.pov", HEAD + "#if (frame_number = 2) #while (1) #end #end\n")
limited = start("bhfarm-worker", "--server", farm.url, "--slots", "1", "--name", "told", "--cpu-limit", "1", log=WORK + "/told.log")
number = bhfarm("submit", "own.pov", "+W16", "+H12", "+KFF5", "--video", "none", server=farm, cwd=WORK).stdout.strip()
told = bhfarm("watch", number, server=farm, good=False)
assert told.returncode == 1 and "--cpu-limit allows, 1 s" in told.stderr.strip().split("\n")[-1], told.stderr
print("%d ways to read, %d to write, %d limits: fenced" % (len(reading), len(writing), len(BOMBS) + 1))
