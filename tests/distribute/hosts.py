# SPDX-License-Identifier: AGPL-3.0-or-later
"""A lab of five hosts, each a network namespace with a cable to one switch: a server with a token and TLS of its own authority, three workers that come, leave, are killed
and lose their cable, and a desk from which each command is tried as a table and with --json. Skipped, and says so, where namespaces are not allowed."""
import json
import os
import re
import signal
import subprocess
import sys

if "inside" not in sys.argv:
    for way in (["unshare", "-mn"], ["unshare", "-Urmn"]):
        if subprocess.run([*way, "sh", "-c", "mount -t tmpfs none /run && ip link set lo up"], capture_output=True).returncode == 0:
            os.execvp("unshare", [*way, sys.executable, os.path.abspath(__file__), sys.argv[1], "inside"])
    print("skipped: network namespaces are not allowed here")
    sys.exit(77)

from authority import authority, certify
from farm import BIN, ENV, PATIENCE, WORK, Gate, bare, new_token, running, same, scene, wait

subprocess.run(["mount", "-t", "tmpfs", "none", "/run"], check=True)
HOSTS = {"server": "10.77.0.1", "one": "10.77.0.2", "two": "10.77.0.3", "three": "10.77.0.4", "desk": "10.77.0.9"}


def ip(*words):
    subprocess.run(["ip", *words], check=True)


ip("link", "add", "switch", "type", "bridge")
ip("link", "set", "switch", "up")
for host, address in HOSTS.items():
    ip("netns", "add", host)
    ip("link", "add", "to-" + host, "type", "veth", "peer", "name", "cable", "netns", host)
    ip("link", "set", "to-" + host, "master", "switch")
    ip("link", "set", "to-" + host, "up")
    for words in (("addr", "add", address + "/24", "dev", "cable"), ("link", "set", "cable", "up"), ("link", "set", "lo", "up")):
        ip("-n", host, *words)


def on(host, *words):
    return ["nsenter", "--net=/run/netns/" + host, BIN + "/" + words[0], *words[1:]]


for name in ("ca", "other"):
    authority(name)
certify("ca", HOSTS["server"])
for name in ("token", "wrong"):
    new_token(name)
ENV.update(BHFARM_SERVER="https://%s:7700" % HOSTS["server"], BHFARM_TOKEN_FILE=WORK + "/token", BHFARM_CA=WORK + "/ca.pem")


def begin(host, *words):
    p = subprocess.Popen(on(host, *words), env=ENV, stdout=subprocess.DEVNULL, stderr=open(WORK + "/" + host + ".log", "a"), start_new_session=True)
    running.append(p)
    return p


def said(host):
    return open(WORK + "/" + host + ".log").read()


def desk(*words, code=0, **changes):
    done = subprocess.run(on("desk", "bhfarm", *words), env=dict(ENV, **changes), capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    if code:
        assert done.stderr.count("\n") == 1 and not done.stdout, (words, done.stdout, done.stderr)
        return done.stderr
    return json.loads(done.stdout) if "--json" in words else done.stdout


def table(*words):
    """A table's rows as dictionaries by its heads; what stands under no head is under ''."""
    lines = desk(*words).rstrip("\n").split("\n")
    heads, at = lines[0].split("  "), []
    names = [h.strip() for h in heads if h.strip()]
    at = [lines[0].index(n) for n in names] + [len(lines[0]) + 1]
    return [dict([(n, line[at[i]:at[i + 1]].strip()) for i, n in enumerate(names)], rest=line[at[-1] - 1:].strip()) for line in lines[1:]]


gates = {host: Gate(BIN + "/standin") for host in ("one", "two", "three")}


def worker(host):
    return begin(host, "bhfarm-worker", "--slots", "1", "--name", host, "--nice", "0", "--cache", WORK + "/cache-" + host, *gates[host].words)


def workers():
    return {w["name"]: w for w in desk("workers", "--json")}


def job(number):
    return desk("status", str(number), "--json")


def submit(*words):
    return desk("submit", ini, "--strips", "10", *words)


# The server: not without a token, where others can come.
naked = subprocess.run(on("server", "bhfarm-server", "--listen", "10.77.0.1:7700", "--spool", WORK + "/spool"), env={**ENV, "BHFARM_TOKEN_FILE": ""}, capture_output=True, text=True)
assert naked.returncode == 1 and "--token-file" in naked.stderr and naked.stderr.count("\n") == 1, naked
assert "no answer from https://10.77.0.1:7700" in desk("status", code=1)
serving = ("bhfarm-server", "--listen", "10.77.0.1:7700", "--spool", WORK + "/spool", "--lease", "6", "--check-every", "0", "--tls-cert", WORK + "/server.pem", "--tls-key", WORK + "/server.key")
server = begin("server", *serving)
wait(lambda: "listening on https://10.77.0.1:7700" in said("server"), "the server", server, WORK + "/server.log")
assert "token" in desk("status", code=1, BHFARM_TOKEN_FILE=WORK + "/wrong")
assert "certificate" in desk("status", code=1, BHFARM_CA=WORK + "/other.pem")
assert desk("status", "--json") == [] and table("status") == [] and desk("workers", "--json") == []
for words, text in ((("status", "1"), "there is no job 1"), (("status", "x"), "number"), (("watch",), "which job"), (("cancel", "7"), "there is no job 7"), (("drain", "nobody"), "there is no worker nobody"),
                    (("fetch", "7"), "there is no job 7"), (("nonsense",), "there is no command"), (("status", "--nonsense"), "no option --nonsense"), (("log", "7"), "there is no job 7"),
                    (("remove", "7"), "there is no job 7")):
    assert text in desk(*words, code=1), words

ini = scene(WORK + "/scene", frames=4, width=64, height=40, ini="Output_File_Name=x")
one, two = worker("one"), worker("two")
wait(lambda: set(workers()) == {"one", "two"}, "two workers", one, WORK + "/one.log")
number = int(submit())
state = job(number)
assert (state["stage"], state["frames"], state["strips"], state["width"], state["name"]) == ("running", 4, 40, 64, "x"), state
row = table("status")[0]
assert (row["JOB"], row["NAME"], row["STAGE"], row["STRIPS"].split("/")[1]) == (str(number), "x", "running", "40"), row
wait(lambda: all(w["busy"] == 1 for w in workers().values()), "both to have work")
row = {w["NAME"]: w for w in table("workers")}
assert set(row) == {"one", "two"} and row["one"]["FROM"] == HOSTS["one"] and row["two"]["FROM"] == HOSTS["two"] and row["one"]["BUSY"] == "1/1", row

# Pause: what is out comes in, nothing goes out. Resume.
assert desk("pause", str(number)) == "" and desk("pause", str(number), "--json")["stage"] == "paused"
for host in ("one", "two"):
    gates[host].let()
wait(lambda: job(number)["strips_out"] == 0, "the farm to rest")
before = job(number)["strips_done"]
assert table("status", str(number))[0]["STAGE"] == "paused"
subprocess.run(["sleep", "1"])
assert job(number)["strips_done"] == before
assert desk("resume", str(number), "--json")["stage"] == "running" and desk("resume", str(number)) == ""

# A worker comes; its cable is cut at work, and its strip goes to another; the cable is back, and so is the worker.
three = worker("three")
wait(lambda: workers().get("three", {}).get("busy") == 1, "the third to have work", three, WORK + "/three.log")
ip("link", "set", "to-three", "down")
wait(lambda: "worker three is not heard of any more" in said("server"), "the server to miss it", server)
ip("link", "set", "to-three", "up")
wait(lambda: workers().get("three", {}).get("busy") == 1, "it to come back", three, WORK + "/three.log")
gates["three"].open()
wait(lambda: workers().get("three", {}).get("done", 0) > 0, "a strip of the third's", three, WORK + "/three.log")
gates["three"].shut()
# One is told to leave and finishes or returns its strip; one is killed. The server too.
one.send_signal(signal.SIGTERM)
gates["one"].let()
assert one.wait(PATIENCE) == 0 and "one" not in workers()
two.kill()
server.kill()
server.wait()
assert "no answer" in desk("status", code=1)
server = begin("server", *serving)
for gate in gates.values():
    gate.open()
two, one = worker("two"), worker("one")
watched = subprocess.run(on("desk", "bhfarm", "watch", str(number), "--json"), env=ENV, capture_output=True, text=True, timeout=PATIENCE)
assert watched.returncode == 0 and json.loads(watched.stdout)["stage"] == "done" and "job %d done" % number in watched.stderr, watched
assert "failed" not in said("server") and desk("log", str(number)) == "" and desk("log", str(number), "--json") == []
names = ["x%d.png" % n for n in range(1, 5)] + ["x.mp4"]
assert desk("fetch", str(number), "--to", WORK + "/out").split() == [WORK + "/out/" + n for n in names]
again = desk("fetch", str(number), "--to", WORK + "/out", "--json")
assert again == {"files": [WORK + "/out/" + n for n in names]}, again
for frame in range(1, 5):
    bare(WORK + "/bare.png", 64, 40, frame)
    same(WORK + "/out/x%d.png" % frame, WORK + "/bare.png")
assert "is done" in desk("cancel", str(number), code=1) and "only one that failed" in desk("retry", str(number), code=1)

# A job that fails says which strip and why; retry makes it run again. Cancel, remove.
broken = submit("Declare=fail=1", "--json")["id"]
failed = subprocess.run(on("desk", "bhfarm", "watch", str(broken)), env=ENV, capture_output=True, text=True, timeout=PATIENCE)
assert failed.returncode == 1 and "job %d failed" % broken in failed.stderr and re.search(
    "frame [1-4], rows [0-9]+ to [0-9]+ failed on 3 tries: standin: Parse Error: told to fail", failed.stderr), failed
assert "told to fail" in table("status", str(broken))[0]["rest"], table("status", str(broken))
log = desk("log", str(broken), "--json")
assert len(log) >= 3 and all(entry["line"] == "standin: Parse Error: told to fail" for entry in log) and {e["worker"] for e in log} <= {"one", "two", "three"}, log
assert desk("log", str(broken)).count("told to fail") >= 6
for gate in gates.values(): # or it may have failed again before it is cancelled
    gate.shut()
assert desk("retry", str(broken), "--json")["stage"] == "running"
assert desk("cancel", str(broken), "--json")["stage"] == "cancelled" and desk("cancel", str(broken)) == ""
assert subprocess.run(on("desk", "bhfarm", "watch", str(broken)), env=ENV, capture_output=True).returncode == 1
wait(lambda: not os.path.exists(WORK + "/spool/jobs/%d/strips" % broken), "its strips to go")
for gate in gates.values():
    gate.open()
assert desk("remove", str(broken), "--json") == {"removed": broken} and desk("remove", str(number)) == ""
assert desk("status", "--json") == []
wait(lambda: os.listdir(WORK + "/spool/jobs") == [], "their folders to go")
# Drained by name and by id, a worker leaves by itself.
assert desk("drain", "one") == "" and one.wait(PATIENCE) == 0
identity = workers()["two"]["id"]
assert desk("drain", identity, "--json") == {"draining": identity} and two.wait(PATIENCE) == 0
assert list(workers()) == ["three"]
three.send_signal(signal.SIGINT)
assert three.wait(PATIENCE) == 0 and workers() == {}
print("five hosts: joined, left, killed, cut off; each command as a table and as JSON")
