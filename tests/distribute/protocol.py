# SPDX-License-Identifier: AGPL-3.0-or-later
"""Runs each curl line of docs/PROTOCOL.md; then what a server must refuse: no token, a wrong one, bodies that are too long, damaged or late."""
import functools
import json
import os
import socket
import subprocess
import time

from farm import BIN, ENV, PATIENCE, WORK, Server, bhfarm, new_token, wait
from hand import BUNDLE, BUNDLE_ID, JOB, ME, SCENE, bring, png, send, sha

TOKEN = new_token()
assert len(TOKEN) == 64
server = Server("--token-file", WORK + "/token", "--lease", str(PATIENCE)) # nothing is lost for want of a heartbeat
ask = functools.partial(server.ask, token=TOKEN)
job = dict(JOB, film_rate=25)
strip = png([bytes([100] * 3 * 8)] * 4)
for name, data in (("bundle.json", json.dumps(BUNDLE).encode()), ("job.json", json.dumps(job).encode()), ("scene.pov", SCENE), ("strip.png", strip)):
    with open(WORK + "/" + name, "wb") as f:
        f.write(data)
variables = {"S": server.url, "T": TOKEN, "FILE": sha(SCENE), "BUNDLE": BUNDLE_ID, "STRIP": sha(strip)}


def curl(line):
    return subprocess.run(["bash", "-c", line], cwd=WORK, env=dict(ENV, **variables), capture_output=True)


def take():
    status, task = ask(ME + "/take", {"wait": 60})
    assert status == 200, (status, task)
    return str(task["lease"])


root = os.path.dirname(os.path.abspath(__file__)) + "/../.."
lines = [l.strip() for l in open(root + "/docs/PROTOCOL.md") if l.startswith("    curl ")]
known = subprocess.run(["grep", "-rhoE", r'router.add\("[A-Z]+", "[^"]+"', root + "/distribute/server"], capture_output=True, text=True).stdout.split("\n")
assert len(lines) >= 25
answers = {}
for line in lines:
    if "$L" in line and ("/failure" in line or "/return" in line):
        variables["L"] = take()
    if line.endswith("/drain"): # before it gets nothing more: the rest of the film
        while ask("/v1/jobs/" + variables["J"])[1]["strips_done"] < 2:
            lease = take()
            assert send(ask, lease, strip)[1]["accepted"]
        wait(lambda: ask("/v1/jobs/" + variables["J"])[1]["stage"] == "done", "the film")
    done = curl(line)
    if "/v1/events" in line:
        while not done.stdout: # a busy machine may need more than the second that is given there
            line = line.replace("-m 1 ", "-m 60 ")
            done = curl(line)
        assert done.returncode == 28, done # curl's word for the end of its patience
        everything = json.loads(done.stdout.split(b"data: ")[1])
        assert everything["event"] == "all" and everything["jobs"][0]["id"] == int(variables["J"]), everything
        continue
    assert done.returncode == 0, "%s\n%s" % (line, done.stderr.decode())
    answers[line] = done.stdout
    if line.endswith("/v1/jobs -d @job.json"):
        variables["J"] = str(json.loads(done.stdout)["job"])
    if "/take" in line:
        task = json.loads(done.stdout)
        assert task["rows"] == 4 and task["spec"]["options"] == job["options"], task
        variables["L"] = str(task["lease"])
    if "/strip?" in line:
        assert json.loads(done.stdout)["accepted"]
        late = json.loads(curl(line).stdout) # once more
        assert not late["accepted"] and "has ended" in late["why"], late


def answer(part):
    return next(a for l, a in answers.items() if part in l)


assert json.loads(answer("@bundle.json")) == {"bundle": BUNDLE_ID, "missing": [sha(SCENE)]}
assert answer("frames/x1.png")[:8] == b"\x89PNG\r\n\x1a\n"
assert b"ftyp" in answer("/film")[:16]
assert json.loads(answer("/pictures"))["pictures"] == ["x1.png", "x2.png"]
assert json.loads(answer("/log"))["failures"][0]["line"] == "Parse Error: ..."
assert not os.path.exists(server.spool + "/jobs/" + variables["J"])
told = " ".join(lines)
for route in known:
    path = route.split('"')[3] if route else ""
    last = path.rsplit("/", 1)[-1]
    assert last in ("", "*", "cancel", "retry") or last in told, "PROTOCOL.md has no line for " + path

# Refusals: one line each, and the server goes on.
LONG = b"x" * (9 << 20)
assert server.ask("/health")[0] == 200
for path in ("/v1/jobs", "/v1/workers", "/v1/events", "/v1/files/" + sha(SCENE)):
    for token in (None, "wrong", TOKEN[:-1], TOKEN + "0"):
        status, got = server.ask(path, token=token)
        assert status == 401 and "token" in got["error"], (path, token, status, got)
for path, body, method, expected in (
        ("/v1/nothing", None, None, 404), ("/v1/jobs/99", None, None, 404), ("/v1/jobs/x", None, None, 404), ("/v1/jobs", None, "DELETE", 405),
        ("/v1/jobs", b"", None, 400), ("/v1/jobs", b"[]", None, 400), ("/v1/jobs", b"{\xff}", None, 400), ("/v1/jobs", LONG, None, 413), ("/v1/jobs", b"{}", None, 400),
        ("/v1/files/" + "0" * 64, b"x", "PUT", 400), ("/v1/files/..%2f..%2fetc", b"x", "PUT", 404), ("/v1/files/" + sha(b"none"), None, None, 404),
        ("/v1/bundles", json.dumps({"folder": "..", "files": []}).encode(), None, 400), ("/v1/leases/1/strip?sha256=x", b"x", "PUT", 400),
        ("/v1/leases/0/return", b"", "POST", 404), ("/v1/workers/nobody-here/take", b'{"wait": 1}', None, 404), ("/v1/workers/%00/take", b"{}", None, 400)):
    status, got = ask(path, raw=body, method=method)
    assert status == expected and "\n" not in got["error"], (path, status, got)

# Strips that are damaged, of the wrong size, or no picture: none is taken, and the lease's strip goes on.
bring(ask)
assert ask("/v1/workers", {"id": "a-worker-of-mine", "name": "x", "slots": 1})[0] == 201
other = {"id": "another-worker", "name": "y", "slots": 1, "povray": "3.8"}
status, got = ask("/v1/workers", other)
assert status == 409 and "its povray is '3.8'" in got["error"] and "'bhfarm drain' it" in got["error"], got
# Who is to leave has no say: a wrong first one keeps nobody out.
bhfarm("drain", "a-worker-of-mine", "--token-file", WORK + "/token", server=server)
assert ask("/v1/workers", other)[0] == 201
assert ask("/v1/workers", {"id": "a-worker-of-mine", "name": "x", "slots": 1})[0] == 409
ask("/v1/workers/another-worker", method="DELETE")
assert ask("/v1/workers", {"id": "a-worker-of-mine", "name": "x", "slots": 1})[0] == 201
number = ask("/v1/jobs", dict(job, animation=False, first=0, last=0, film_rate=0))[1]["job"]
lease = take()
assert send(ask, lease, strip[:-1], sha(strip))[0] == 422
assert send(ask, lease, strip + b"x", sha(strip))[0] == 422
broken = strip[:-20] + b"\0" + strip[-19:]
got = send(ask, lease, broken)[1]
assert not got["accepted"] and "no good picture" in got["why"], got # as a failure of the worker's
assert "has ended" in send(ask, lease, strip)[1]["why"]
wait(lambda: ask("/v1/jobs/%d" % number)[1]["strips_out"] == 0, "the strip to come back")
other = png([bytes([100] * 3 * 8)] * 5)
lease = take()
send(ask, lease, other)
assert ask("/v1/jobs/%d" % number)[1]["strips_done"] == 0
failures = ask("/v1/jobs/%d/log" % number)[1]["failures"]
assert "no good picture" in failures[0]["line"] and "8x5" in failures[1]["line"], failures

# A worker whose connection breaks while it waits gets nothing lent: the strip is there for the next.
ask("/v1/jobs/%d" % number, method="DELETE")
ask("/v1/workers", {"id": "gone-worker", "name": "z", "slots": 1})
s = socket.create_connection((server.host, server.port))
body = b'{"wait": 60}'
s.sendall(b"POST /v1/workers/gone-worker/take HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer %s\r\nContent-Length: %d\r\n\r\n%s" % (TOKEN.encode(), len(body), body))
time.sleep(0.3)
s.close()
time.sleep(0.3)
number = ask("/v1/jobs", dict(job, client_key="k"))[1]["job"]
assert ask("/v1/jobs", dict(job, client_key="k"))[1]["job"] == number
time.sleep(0.3)
wait(lambda: ask("/v1/jobs/%d" % number)[1]["strips_out"] == 0, "what nobody hears of to come back")
# Garbage, and half a request, hurt nobody.
for text in (b"\0" * 100, b"GET", b"GET / HTTP/1.1\r\n" + b"A: " + b"x" * 100000, b"PUT /v1/files/%s HTTP/1.1\r\nAuthorization: Bearer %s\r\nContent-Length: 99\r\n\r\nx" % (b"0" * 64, TOKEN.encode())):
    s = socket.create_connection((server.host, server.port))
    s.sendall(text)
    s.close()
assert server.ask("/health")[0] == 200
assert server.process.poll() is None
wait(lambda: os.listdir(server.spool + "/incoming") == [], "incoming to be empty")
open_to_all = subprocess.run([BIN + "/bhfarm-server", "--listen", "0.0.0.0:0", "--spool", WORK + "/s2"], env=ENV, capture_output=True, text=True)
assert open_to_all.returncode == 1 and "--token-file" in open_to_all.stderr, open_to_all.stderr
taken = subprocess.run([BIN + "/bhfarm-server", "--listen", "%s:%d" % (server.host, server.port), "--spool", WORK + "/s3"], env=ENV, capture_output=True, text=True)
assert taken.returncode == 1 and "Address already in use" in taken.stderr and taken.stderr.count("\n") == 1, taken.stderr
locked = subprocess.run([BIN + "/bhfarm-server", "--listen", "127.0.0.1:0", "--spool", server.spool], env=ENV, capture_output=True, text=True)
assert locked.returncode == 1 and "another bhfarm-server" in locked.stderr, locked.stderr
print("%d lines of PROTOCOL.md; refusals" % len(lines))
