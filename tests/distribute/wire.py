# SPDX-License-Identifier: AGPL-3.0-or-later
"""Damaged requests, byte by byte over the wire, to a live bhfarm-server: each gets an answer below 500 in one line or a closed connection, and the server goes on and
knows what it knew. wire.py BIN [COUNT [SEED]]"""
import functools
import json
import random
import re
import socket
import sys

from farm import PATIENCE, WORK, Server, new_token
from hand import BUNDLE, BUNDLE_ID, HELLO, JOB, ME, SCENE, give, sha

COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 10000 # some seconds; not a time, as what is tried must not hang on the machine
random.seed(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
TOKEN = new_token()
server = Server("--token-file", WORK + "/token")
SHA = sha(SCENE)


def request(method, path, body=b"", headers=()):
    body = body if isinstance(body, bytes) else json.dumps(body).encode()
    lines = ["%s %s HTTP/1.1" % (method, path), "Host: farm", "Authorization: Bearer " + TOKEN, "Connection: close", *headers]
    if body or method != "GET":
        lines.append("Content-Length: %d" % len(body))
    return ("\r\n".join(lines) + "\r\n\r\n").encode() + body


ask = functools.partial(server.ask, token=TOKEN)
assert give(ask, film_rate=25) == 1
assert ask("/v1/workers", HELLO)[0] == 201
lease = ask(ME + "/take", {"wait": 1})[1]["lease"]
GOOD = [request("GET", "/health"), request("POST", "/v1/bundles", BUNDLE), request("PUT", "/v1/files/" + SHA, SCENE), request("GET", "/v1/bundles/" + BUNDLE_ID),
        request("GET", "/v1/files/" + SHA), request("POST", "/v1/jobs", dict(JOB, film_rate=25, client_key="one")), request("GET", "/v1/jobs"), request("GET", "/v1/jobs/1/strips"),
        request("GET", "/v1/jobs/1/frames/x1.png?size=1"), request("POST", "/v1/jobs/1/pause"), request("POST", "/v1/jobs/1/resume"), request("GET", "/v1/jobs/1/log"),
        request("POST", "/v1/workers", HELLO), request("POST", ME + "/take", {"wait": 0}), request("POST", ME + "/heartbeat", {"leases": [lease]}),
        request("POST", ME + "/drain"), request("GET", "/v1/workers", headers=["Cookie: a=b; token=" + TOKEN, "Accept: text/html", "If-None-Match: \"x\""]),
        request("PUT", "/v1/leases/%d/strip?sha256=%s&seconds=1.5" % (lease, SHA), SCENE), request("POST", "/v1/leases/%d/return" % lease),
        request("POST", "/v1/leases/%d/failure" % lease, {"line": "Parse Error: ...", "log": "x\n"}), request("GET", "/", headers=["Range: bytes=0-10"]),
        request("POST", "/v1/jobs", dict(JOB, film_rate=25), ["Transfer-Encoding: chunked"]), request("PUT", "/v1/files/" + SHA, SCENE, ["Expect: 100-continue"])]
MARKS = [b"\r\n", b"\0", b"%", b"%00", b"../", b"\"", b"{", b"[" * 200, b"\xff\xfe", b"-1", b"0", b"99999999999999999999", b"1e999", b"null", b": ", b" ", b"?", b"&", b"=",
         b"Content-Length: 5\r\n", b"Transfer-Encoding: chunked\r\n", b"x" * 20000]


def damaged(data):
    for _ in range(random.randint(1, 4)):
        at, kind = random.randrange(len(data) + 1), random.randrange(5)
        if kind == 0:
            data = data[:at] + bytes([random.randrange(256)]) + data[at + 1:]
        elif kind == 1:
            data = data[:at] + data[at + random.randint(1, 12):]
        elif kind == 2:
            data = data[:at] + random.choice(MARKS) + data[at:]
        elif kind == 3:
            other = random.choice(GOOD)
            start = random.randrange(len(other))
            data = data[:at] + other[start:start + random.randint(1, 40)] + data[at:]
        else: # a number is another
            numbers = list(re.finditer(rb"\d+", data))
            number = random.choice(numbers)
            data = data[:number.start()] + random.choice([b"0", b"-1", b"4294967296", b"1.5", b"9" * 30]) + data[number.end():]
    return data


def answered(data):
    """What came back before the connection closed."""
    with socket.create_connection((server.host, server.port), timeout=PATIENCE) as s:
        got = b""
        try:
            s.sendall(data)
            s.shutdown(socket.SHUT_WR)
            while piece := s.recv(1 << 16):
                got += piece
                if b"text/event-stream" in got: # goes on for ever
                    break
        except OSError: # closed by the other side
            pass
    return got


codes = {}
for _ in range(COUNT):
    data = damaged(random.choice(GOOD))
    got = answered(data)
    code = got[9:12].decode("latin-1") if got else "none"
    codes[code] = codes.get(code, 0) + 1
    assert code == "none" or code == "100" or "200" <= code < "500" or code == "507", (data, got)
    if "400" <= code < "500" and b"application/json" in got:
        # What was left of a damaged request may have had an answer of its own.
        error = json.JSONDecoder().raw_decode(got.split(b"\r\n\r\n", 1)[1].decode("utf-8"))[0]["error"]
        assert error and "\n" not in error, (data, got)
    assert server.process.poll() is None, ("the server died of", data, open(server.log).read()[-2000:])
for good in GOOD[:5]:
    assert answered(good)[9:12] in (b"200", b"201"), good
told = ask("/v1/jobs/1")
assert told[0] == 200 and told[1]["spec"]["name"] == "x", told
server.process.kill()
server.process.wait()
server.again() # whatever was written can be read
assert ask("/v1/jobs/1")[1]["spec"]["name"] == "x"
print("%d damaged requests: %s" % (COUNT, ", ".join("%s %d" % c for c in sorted(codes.items()))))
