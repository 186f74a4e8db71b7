# SPDX-License-Identifier: AGPL-3.0-or-later
"""What the page stands on: the stream of changes, previews of frames, and the door for browsers. Workers and strips are made up here."""
import functools
import http.client
import json
import struct
import time
import urllib.parse

from farm import ENV, PATIENCE, WORK, Server, bhfarm, new_token, pixels, wait
from hand import BUNDLE, JOB, bring, png, send

TOKEN = new_token()
server = Server("--token-file", WORK + "/token", "--check-every", "0", "--lease", "3600") # nobody here sends heartbeats
ask = functools.partial(server.ask, token=TOKEN)


class Stream:
    """Server-sent events, read as they come."""
    def __init__(self, of):
        self.connection = http.client.HTTPConnection(of.host, of.port, timeout=PATIENCE)
        self.connection.request("GET", "/v1/events", headers={"Authorization": "Bearer " + TOKEN})
        self.answer = self.connection.getresponse()
        assert self.answer.status == 200 and self.answer.getheader("Content-Type") == "text/event-stream"

    def next(self):
        while True:
            line = self.answer.readline()
            assert line, "the stream has ended"
            if line.startswith(b"data: "):
                return json.loads(line[6:])

    def until(self, condition):
        end = time.monotonic() + PATIENCE
        while True:
            piece = self.next()
            assert time.monotonic() < end, "the stream does not tell"
            if condition(piece):
                return piece


# The stream: first everything, then what changes, as it stands.
bring(ask)
W, H, ROWS = 60, 45, 10  # five strips, the last of 5 rows
job = dict(JOB, options=[], width=W, height=H, first=3, last=7, step=2, digits=2, bits=16, strip_rows=ROWS)
stream = Stream(server)
first = stream.next()
assert first["event"] == "all" and first["jobs"] == [] and first["workers"] == [], first
number = ask("/v1/jobs", job)[1]["job"]
piece = stream.until(lambda p: p.get("jobs"))
assert piece["jobs"] == [{k: v for k, v in ask("/v1/jobs/%d" % number)[1].items() if k != "spec"}] and piece["jobs"][0]["format"] == "png", piece
for name in ("one-worker", "two-worker"):
    assert ask("/v1/workers", {"id": name, "name": name, "slots": 2})[0] == 201


def take(who="one-worker"):
    status, task = ask("/v1/workers/%s/take" % who, {"wait": 60})
    assert status == 200
    return task


letters = {}  # as a watcher puts them together


def follow(strip, letter):
    def seen(piece):
        for at, l in piece.get("strips", {}).get(str(number), []):
            letters[at] = l
        return letters.get(strip) == letter
    stream.until(seen)


def picture(frame, row, rows):
    """A gradient with an edge, another for each frame."""
    return [[v for x in range(W) for v in (x * 65535 // (W - 1), (row + y) * 65535 // (H - 1), 65535 if (x * 7 + (row + y) * 3 + frame * 5) % 11 < 4 else 0)]
            for y in range(rows)]


def report(task):
    rows = [struct.pack(">%dH" % len(r), *r) for r in picture(task["frame"], task["row"], task["rows"])]
    got = send(ask, task["lease"], png(rows, depth=16, more=[(b"sRGB", b"\0")])) # gamma as povray's
    assert got[0] == 200 and got[1]["accepted"], got


task = take()
assert (task["frame"], task["row"]) == (3, 0)
follow(0, "o")
ask("/v1/leases/%d/failure" % task["lease"], {"line": "Parse Error: x", "log": ""})
follow(0, "r")
again = take("two-worker")
assert again["row"] == 0
follow(0, "a")
report(again)
follow(0, "s")
task = take()
follow(1, "o")
ask("/v1/leases/%d/return" % task["lease"], method="POST", raw=b"")
follow(1, "w")
assert ask("/v1/jobs/%d/strips" % number)[1]["strips"] == "s" + "w" * 14
ask("/v1/workers/two-worker/drain", method="POST", raw=b"")
assert [w["draining"] for w in stream.until(lambda p: p.get("workers"))["workers"]] == [True]
ask("/v1/workers/two-worker", method="DELETE")
assert stream.until(lambda p: p.get("gone"))["gone"] == ["two-worker"]

# A preview has the rows that have come where they belong, and nothing elsewhere.
to_linear = [c / 65535 / 12.92 if c / 65535 <= 0.04045 else ((c / 65535 + 0.055) / 1.055) ** 2.4 for c in range(65536)]


def from_linear(v):
    return 255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)


def preview(frame, size, job_number=None):
    status, data = ask("/v1/jobs/%d/preview/%d?size=%d" % (job_number or number, frame, size))
    assert status == 200, data
    with open(WORK + "/preview.png", "wb") as f:
        f.write(data)
    (width, height, depth, colour), data = pixels(WORK + "/preview.png")
    assert (depth, colour) == (8, 6)
    return width, height, [data[4 * i:4 * i + 4] for i in range(width * height)]


def expect(frame, size, strips):
    """The mean in linear light of what has come, by another way than the server's: pixel by pixel."""
    width, height, got = preview(frame, size)
    shrink = min(1, size / max(W, H))
    assert (width, height) == (round(W * shrink), round(H * shrink)), (width, height)
    whole = picture(frame, 0, H)
    for v in range(height):
        ys = [y for y in range(H) if y * height // H == v and y // ROWS in strips]
        for u in range(width):
            pixel = got[v * width + u]
            if not ys:
                assert pixel[3] == 0, (u, v, tuple(pixel))
                continue
            xs = range(u * W // width, (u + 1) * W // width)
            assert pixel[3] == 255
            for c in range(3):
                mean = sum(to_linear[whole[y][3 * x + c]] for y in ys for x in xs) / (len(ys) * len(xs))
                assert abs(from_linear(mean) - pixel[c]) <= 1, (size, u, v, c, from_linear(mean), pixel[c])


expect(3, 320, {0})  # larger than the frame: as large as it
expect(3, 25, {0})
while (task := take())["frame"] == 3:
    report(task)
    if task["row"] == 20:
        expect(3, 25, {0, 1, 2})
expect(3, 25, {0, 1, 2, 3, 4})
expect(3, 320, {0, 1, 2, 3, 4})
expect(5, 25, set())
report(task)
expect(5, 31, {0})
at = server


def plain(method, path, body=None, **headers):
    """Status, headers and body, without following anything; underscores in names are dashes."""
    connection = http.client.HTTPConnection(at.host, at.port, timeout=PATIENCE)
    connection.request(method, path, body=body, headers={k.replace("_", "-"): v for k, v in headers.items()})
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, dict(answer.getheaders()), body


BEARER = {"Authorization": "Bearer " + TOKEN}
status, head, body = plain("GET", "/v1/jobs/%d/preview/3?size=25" % number, **BEARER)
assert plain("GET", "/v1/jobs/%d/preview/3?size=25" % number, If_None_Match=head["ETag"], **BEARER)[0] == 304
for path, expected in (("preview/4", 404), ("preview/8", 404), ("preview/x", 400), ("preview/3?size=0", 400), ("preview/3?size=5000", 400)):
    assert ask("/v1/jobs/%d/%s" % (number, path))[0] == expected, path
while True: # to the end; then the strips are gone, and the preview comes from the frame
    if ask("/v1/jobs/%d" % number)[1]["strips_done"] == 15:
        break
    report(take())
wait(lambda: ask("/v1/jobs/%d" % number)[1]["stage"] == "done", "the job")
expect(7, 25, {0, 1, 2, 3, 4})
ask("/v1/jobs/%d" % number, method="DELETE")
assert stream.until(lambda p: p.get("removed"))["removed"] == [number]
large = ask("/v1/jobs", dict(job, width=40000, height=30, strip_rows=30, client_key="l"))[1]["job"]
assert preview(3, 1024, large)[:2] == (1024, 1)
ask("/v1/jobs/%d" % large, method="DELETE")

# An OpenEXR strip shows what a PNG strip does.
with open(WORK + "/exr.pov", "w") as f:
    f.write("#version 3.7;\nglobal_settings { assumed_gamma 1 }\nbackground { rgb <0.2, 0.5, 1> }\ncamera { location -5*z look_at 0 }\nlight_source { <5, 5, -9> 2 }\n"
            "sphere { 0, 1 pigment { checker rgb 1 rgb <1, 0.1, 0> scale 0.3 } }\n")
ENV["BHFARM_TOKEN_FILE"] = WORK + "/token"
for name in ("one-worker", "two-worker"):
    ask("/v1/workers/" + name, method="DELETE")
worker = server.worker()
shown = []
for kind in ("png", "exr"):
    still = int(bhfarm("submit", WORK + "/exr.pov", "+W80", "+H96", "+A", "Bits_Per_Color=16", "--priority", "9", "--strips", "3", "--format", kind, server=server).stdout)
    bhfarm("watch", str(still), server=server)
    shown.append(preview(0, 48, still))
differ = max(abs(x - y) for p, q in zip(shown[0][2], shown[1][2]) for x, y in zip(p, q))
assert shown[0][:2] == shown[1][:2] == (40, 48) and differ <= 1, differ
worker.terminate()
worker.wait(PATIENCE)

# The door for browsers.
OWN = {"Origin": server.url}
token_form = urllib.parse.urlencode({"token": TOKEN})
status, head, body = plain("GET", "/")
assert status == 401 and b"<form" in body and b"<script" not in body and "default-src 'none'" in head["Content-Security-Policy"] and "WWW-Authenticate" in head
assert plain("POST", "/sign-in", token_form)[0] == 403 and plain("POST", "/sign-in", token_form, Origin="http://evil.example")[0] == 403
status, head, body = plain("POST", "/sign-in", "token=wrong", **OWN)
assert status == 401 and "Set-Cookie" not in head and b"not a token" in body
assert plain("POST", "/sign-in", "x" * 5000, **OWN)[0] == 413
status, head, body = plain("POST", "/sign-in", "token=+" + TOKEN + "%0A", **OWN)
assert status == 303 and head["Location"] == "/", (status, body)
parts = head["Set-Cookie"].split("; ")
cookie = {"Cookie": "other=1; " + parts[0] + "; more=2"}
assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(parts) and TOKEN not in parts[0], parts
for path in ("/", "/page/main.js", "/page/layout.css", "/page/icon.svg", "/v1/jobs", "/source"):
    assert plain("GET", path)[0] == 401, path
    status, head, body = plain("GET", path, **cookie)
    assert status == 200 and body and head["X-Content-Type-Options"] == "nosniff", path
    if "ETag" in head:
        assert "script-src 'self'" in head["Content-Security-Policy"] and "unsafe" not in head["Content-Security-Policy"]
        status, _, body = plain("GET", path, If_None_Match=head["ETag"], **cookie)
        assert status == 304 and body == b"", path
assert plain("GET", "/page/sign_in.html", **cookie)[0] == 404 and plain("GET", "/page/..%2Fmain.js", **cookie)[0] == 404
pause = "/v1/jobs/%d/pause" % ask("/v1/jobs", dict(job, client_key="p"))[1]["job"]
for headers, expected in (({}, 403), ({"Origin": "http://evil.example"}, 403), ({"Origin": "null"}, 403), ({"Sec_Fetch_Site": "same-site", **OWN}, 403),
                          ({"Sec_Fetch_Site": "cross-site"}, 403), (OWN, 200), ({"Sec_Fetch_Site": "same-origin"}, 200)):
    assert plain("POST", pause, "", **cookie, **headers)[0] == expected, headers
assert plain("POST", pause, "", Origin="http://evil.example", **BEARER)[0] == 200 # a token is never sent by accident
assert plain("GET", "/v1/jobs", Cookie=parts[0][:-1])[0] == 401 and plain("GET", "/v1/jobs", Cookie=parts[0] + "0")[0] == 401
assert plain("GET", "/v1/jobs", Cookie=parts[0].split("=")[0] + "=" + TOKEN)[0] == 401
status, head, _ = plain("POST", "/sign-out", "", **cookie, **OWN)
assert status == 303 and "Max-Age=0" in head["Set-Cookie"] and plain("GET", "/v1/jobs", **cookie)[0] == 401

# Without tokens whoever is on this machine comes in, but no web page of somebody else's.
ENV.pop("BHFARM_TOKEN_FILE")
open_one = Server()
at = open_one
there = "/v1/bundles", json.dumps(BUNDLE)
assert plain("POST", *there)[0] == 201 and plain("POST", *there, Origin=open_one.url)[0] == 201
assert plain("POST", *there, Origin="http://evil.example")[0] == 403 and plain("POST", *there, Sec_Fetch_Site="cross-site")[0] == 403
assert plain("GET", "/v1/jobs", Host="localhost:1")[0] == 200 and plain("GET", "/v1/jobs", Host="127.evil.example")[0] == 403 and plain("GET", "/", Host="evil.example:80")[0] == 403
print("stream, previews and door")
