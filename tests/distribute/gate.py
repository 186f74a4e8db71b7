# SPDX-License-Identifier: AGPL-3.0-or-later
"""What a server lets in: no route but /health without the token, no token that only looks like it, no bundle that leaves its place or is too large, no endless
request. Each refusal is one line, and nothing of it stays in the spool."""
import glob
import hashlib
import json
import os
import re
import socket
import time
import urllib.parse

import hand
from farm import PATIENCE, WORK, Server, new_token, wait

TOKEN = new_token()
server = Server("--token-file", WORK + "/token", "--idle", str(PATIENCE))


def talk(*pieces, close=False):
    """Sends them as they are and gives the answer's status and its error."""
    with socket.create_connection((server.host, server.port), timeout=PATIENCE) as s:
        try:
            for piece in pieces:
                s.sendall(piece)
            if close:
                s.shutdown(socket.SHUT_WR)
        except OSError: # it has heard enough
            pass
        got = b""
        try:
            while more := s.recv(65536):
                got += more
                head, _, body = got.partition(b"\r\n\r\n")
                length = re.search(rb"(?i)content-length: (\d+)", head)
                if length and (pieces[0].startswith(b"HEAD") or body and len(body) >= int(length.group(1))):
                    break
        except ConnectionResetError:
            pass
    head, _, body = got.partition(b"\r\n\r\n")
    status = int(got.split()[1]) if got else 0
    try:
        error = json.loads(body).get("error", "") if body else ""
    except ValueError:
        error = ""
    return status, error


def request(method, path, *headers, body=b"", token=TOKEN):
    lines = ["%s %s HTTP/1.1" % (method, path), "Host: x", *(["Authorization: Bearer " + token] if token is not None else []), *headers]
    if not any(h.lower().startswith(("content-length", "transfer-encoding")) for h in headers):
        lines.append("Content-Length: %d" % len(body))
    return "\r\n".join(lines).encode("latin-1") + b"\r\n\r\n" + body


def spool():
    """Everything in it but the ledger's own files."""
    found = []
    for folder, _, files in os.walk(server.spool):
        found += [os.path.join(folder, f) for f in files if not f.startswith(("ledger", "lock", "url"))]
    return found


# Every route there is, in whatever file it is added.
root = os.path.dirname(os.path.abspath(__file__)) + "/../../distribute/"
routes, added = [], 0
for name in glob.glob(root + "**/*.cpp", recursive=True):
    text = open(name).read()
    if name.endswith("http/router.cpp"):
        continue
    added += len(re.findall(r"\b\w*[rR]outer\w*(?:\.|->)add\(", text))
    routes += re.findall(r'\b\w*[rR]outer\w*(?:\.|->)add\(\s*"([A-Z]+)",\s*"([^"]+)"', text)
assert added == len(routes) >= 27, "%d routes are added, %d could be read" % (added, len(routes))
# The door itself asks for the token in its own way.
FREE = {("GET", "/health"), ("POST", "/sign-in")}
flipped = TOKEN[:-1] + ("0" if TOKEN[-1] != "0" else "1")
wrong = [None, "", " ", "x", TOKEN[:-1], TOKEN + "0", TOKEN.upper(), flipped, " " + TOKEN, TOKEN + " x", TOKEN + "\t" + TOKEN, TOKEN + "," + TOKEN, "Bearer " + TOKEN, "*", "null", "\xff" * 64,
         "0" * 64, TOKEN[1:], TOKEN * 2]
assert TOKEN.upper() != TOKEN
open_ones = set()
for method, pattern in routes:
    path = pattern.replace("*", "1")
    for token in wrong[:6]:
        status, error = talk(request(method, path, "Connection: close", token=token))
        if status == 401:
            assert "\n" not in error, error
        else:
            open_ones.add((method, pattern))
            assert status == 403 or pattern == "/health", (method, pattern, status)
    status = talk(request("HEAD" if method == "GET" else method, path, "Connection: close", token=None))[0]
    assert status == 401 or (method, pattern) in FREE, (method, path, status)
assert open_ones == FREE, open_ones
for token in wrong:
    assert talk(request("GET", "/v1/jobs", "Connection: close", token=token))[0] == 401, repr(token)
for line in ("Authorization: bearer " + TOKEN, "Authorization: Basic " + TOKEN, "Authorization: " + TOKEN, "Authorization:Bearer" + TOKEN, "X-Authorization: Bearer " + TOKEN,
             "Authorization: Bearer  " + TOKEN):
    assert talk(request("GET", "/v1/jobs", line, "Connection: close", token=None))[0] == 401, line
for token in wrong:
    if token is None or token.strip() == TOKEN: # who pastes a token may paste the blank beside it
        continue
    body = "token=" + urllib.parse.quote(token.encode("latin-1"))
    status, error = talk(request("POST", "/sign-in", "Origin: http://x", "Connection: close", body=body.encode(), token=None))
    assert status == 401 and not error, (token, status)
for name in ("bhfarm", "bhfarm-%d" % server.port, "__Host-bhfarm-%d" % server.port):
    for value in ("", TOKEN, "0" * 64, "*"):
        assert talk(request("GET", "/v1/jobs", "Cookie: %s=%s" % (name, value), "Connection: close", token=None))[0] == 401, (name, value)
for path in ("/v1/jobs?token=" + TOKEN, "/v1//jobs", "//v1/jobs", "/V1/jobs", "/v1/jobs/", "/health/../v1/jobs", "/health/%2e%2e/v1/jobs", "/v1/jobs%00", "/health?x=/v1/jobs"):
    status, error = talk(request("GET", path, "Connection: close", token=None))
    assert status in (400, 401, 404) or path.startswith("/health?"), (path, status)
assert talk(request("GET", "/v1/jobs", "Connection: close"))[0] == 200
# Nobody who has no token makes the server read, or keep, a body.
status, error = talk(request("PUT", "/v1/files/" + "0" * 64, "Content-Length: 2000000000", token=None), b"x" * 100000)
assert status == 401 and spool() == [], (status, spool())

# Bundles.
HASH = "0" * 64


def named(*names, folder="", size=1):
    return {"folder": folder, "files": [{"name": n, "sha256": HASH, "bytes": size} for n in names]}


def refused(body, what, say=""):
    raw = body if isinstance(body, bytes) else json.dumps(body, ensure_ascii=False).encode("utf-8", "surrogateescape")
    status, error = talk(request("POST", "/v1/bundles", "Connection: close", body=raw))
    assert status in (400, 413) and error and "\n" not in error and len(error) < 300 and say in error, (what, status, error)
    assert all(c.isprintable() for c in error), (what, error)
    assert spool() == [], (what, spool())


for name in ("../x", "a/../../x", "..", ".", "a/..", "/etc/passwd", "//etc/passwd", "a//b", "a/", "./a", "", "a\nb", "a\x1b[2Jb", "a\0b", "a\x7fb", "x" * 10240, "x" * 300, "/" * 50):
    refused(named(name), repr(name)[:60], "name")
refused(named("a\udcffb.inc"), "a name that is not UTF-8")
refused(json.dumps(named("a\ud800b")).encode(), "half a surrogate pair")
for names in (("a", "a"), ("a", "a/b"), ("a", "a-b", "a/b"), ("a/b", "a/b/c")):
    refused(named(*names), names, "the bundle has 'a")
refused(named("a/b", folder="a/b"), "a folder that is a file")
refused(named("a", folder="../x"), "a folder outside", "folder")
refused(named("a", size=10 << 30), "a file of 10 GB", "bytes")
refused(named(*("f%d" % i for i in range(10)), size=(1 << 30)), "10 files of 1 GB", "bytes")
refused(named("a", size=-1), "less than nothing", "bytes")
refused(named(*("f%d" % i for i in range(30000))), "30,000 files", "files")
refused(named(*("f%d" % i for i in range(1000000))), "a million files", "bytes")
for kind in ("link", "symlink", "target", "mode", "type"): # there are no links: what a list says of them is nothing to the server
    one = named("a")
    one["files"][0][kind] = "/etc/passwd"
    status, answer = server.ask("/v1/bundles", one, token=TOKEN)
    assert status == 201
    kept = server.ask("/v1/bundles/" + answer["bundle"], token=TOKEN)[1]
    assert kept == named("a"), kept
for left in spool():
    os.remove(left)
for body in (b"", b"[]", b"{", b'{"files": 1}', b"[" * 100000, b'{"a":' * 100000, b"\x1f\x8b\x08" + bytes(1000), b"PK\x03\x04" + bytes(1000)):
    refused(body, body[:10])

# Bodies that lie. A file is what its name says, or is gone.
data = b"x" * 1000
digest = hashlib.sha256(data).hexdigest()
PUT = "/v1/files/" + digest
status, error = talk(request("PUT", PUT, "Content-Length: 5000"), data, close=True)
assert status == 0
for line, body, expected in (("Content-Length: 10000000000", b"x", 413), ("Content-Length: 999", data, 400), ("Content-Length: -1", b"", 400), ("Content-Length: 1e3", data, 400),
                             ("Content-Length: 99999999999999999999999", b"", 400), ("Transfer-Encoding: chunked", b"zz\r\n", 0), ("Transfer-Encoding: chunked", b"-1\r\n", 0)):
    status, error = talk(request("PUT", PUT, line, "Connection: close"), body, close=True)
    assert status in ((expected,) if expected else (0, 400)) and "\n" not in error, (line, status, error)
assert talk(request("PUT", "/v1/files/" + digest[:-1] + ("0" if digest[-1] != "0" else "1"), "Connection: close", body=data))[0] == 400
piece = b"100000\r\n" + b"x" * (1 << 20) + b"\r\n"
status, error = talk(request("POST", "/v1/bundles", "Transfer-Encoding: chunked"), *[piece] * 40) # a message without an end
assert status == 413 and "longer" in error, (status, error)
wait(lambda: spool() == [], "the spool to be empty")

# Headers without end, none at all, and a connection that says nothing.
status, error = talk(request("GET", "/health", *("X-%d: %s" % (i, "x" * 1000) for i in range(2000))))
assert status == 431 and "headers" in error, (status, error)
assert talk(b"GET /" + b"x" * (1 << 20) + b" HTTP/1.1\r\n\r\n")[0] in (400, 431)
assert talk(b"\x16\x03\x01\x02\x00" + bytes(200))[0] == 400
hasty = Server("--idle", "2")
for said in (b"", b"GET /health HT", b"GET /health HTTP/1.1\r\nHost: x\r\n", b"GET /health HTTP/1.1\r\nHost: x\r\n\r\n"): # answered, or half said: then nothing more
    start = time.monotonic()
    with socket.create_connection((hasty.host, hasty.port), timeout=PATIENCE) as s:
        s.sendall(said)
        while s.recv(65536):
            pass
    assert time.monotonic() - start > 1.5, said # and it ends at all
assert hasty.ask("/health")[0] == 200
assert server.ask("/health")[0] == 200 and server.process.poll() is None
# A list that says less than the files have would get round the limits: no job is made of it.
for size in (0, len(hand.SCENE) - 1, len(hand.SCENE) + 1):
    false = dict(hand.BUNDLE, files=[dict(hand.BUNDLE["files"][0], bytes=size)])
    false_id = server.ask("/v1/bundles", false, token=TOKEN)[1]["bundle"]
    assert server.ask("/v1/files/" + hand.sha(hand.SCENE), raw=hand.SCENE, method="PUT", token=TOKEN)[0] == 201
    status, answer = server.ask("/v1/jobs", dict(hand.JOB, bundle=false_id), token=TOKEN)
    assert status == 409 and "scene.pov has 11 bytes, and its list says %d" % size in answer["error"], (size, status, answer)
print("%d routes; tokens, bundles, bodies and headers refused" % len(routes))
