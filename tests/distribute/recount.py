# SPDX-License-Identifier: AGPL-3.0-or-later
"""Killed when two workers' reports against a third's had been committed, and what follows from them had not: the next start counts the votes, sets the third aside, and a
frame that was stitched with its strip is stitched anew. recount.py BIN"""
import hashlib
import json
import os
import sqlite3
import struct
import zlib

from farm import WORK, Server, pixels, wait

WIDTH, ROWS = 8, 2
SCENE = b"camera { }\n"
SHA = hashlib.sha256(SCENE).hexdigest()


def png(grey):
    """Rows of one grey as a picture of their own."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = (b"\0" + bytes([grey]) * 3 * WIDTH) * ROWS
    header = struct.pack(">IIBBBBB", WIDTH, ROWS, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def name_of(grey):
    """By which the ledger names these pixels."""
    return hashlib.sha256(b"png 2 8 0\n" + bytes([grey]) * 3 * WIDTH * ROWS).hexdigest()


server = Server("--check-every", "0")
bundle = {"files": [{"bytes": len(SCENE), "name": "scene.pov", "sha256": SHA}], "folder": ""}
assert server.ask("/v1/bundles", bundle)[0] == 201
assert server.ask("/v1/files/" + SHA, raw=SCENE, method="PUT")[0] == 201
job = {"name": "x", "bundle": hashlib.sha256(json.dumps(bundle, separators=(",", ":"), sort_keys=True).encode()).hexdigest(), "options": ["Input_File_Name=scene.pov"],
       "width": WIDTH, "height": 2 * ROWS, "animation": True, "first": 1, "last": 2, "step": 1, "digits": 1, "format": "png", "bits": 8, "strip_rows": ROWS, "film_rate": 0}
assert server.ask("/v1/jobs", job)[1] == {"job": 1}


def take_and_send(worker, grey):
    """Whether there was a strip to send."""
    me = worker + "-" * (16 - len(worker))
    assert server.ask("/v1/workers", {"id": me, "name": worker, "slots": 1, "povray": "3.7", "probe": ""})[0] in (200, 201)
    status, task = server.ask("/v1/workers/%s/take" % me, {"wait": 1})
    strip = png(grey)
    if status == 200:
        assert server.ask("/v1/leases/%d/strip?sha256=%s&seconds=1" % (task["lease"], hashlib.sha256(strip).hexdigest()), raw=strip, method="PUT")[0] == 200
        return task["frame"], task["row"]
    return None


assert take_and_send("liar", 0) == (1, 0)
assert take_and_send("honest", 255) == (1, ROWS)
wait(lambda: server.ask("/v1/jobs/1")[1]["frames_done"] == 1, "the first frame", server.process, server.log)
frame = server.spool + "/jobs/1/frames/x1.png"
assert set(pixels(frame)[1]) == {0, 255}
server.process.kill()
server.process.wait()
db = sqlite3.connect(server.spool + "/ledger.sqlite")
for worker in ("one-one-one-one-", "two-two-two-two-"):
    db.execute("INSERT INTO report(job, strip, worker, pixels, seconds, settled) VALUES(1, 0, ?, ?, 1, 0)", (worker, name_of(255)))
db.commit()
db.close()
with open("%s/jobs/1/strips/0-%s.png" % (server.spool, name_of(255)[:16]), "wb") as f:
    f.write(png(255))
server.again()
wait(lambda: "worker liar------------ is set aside" in open(server.log).read(), "the liar to be found", server.process, server.log)
while take_and_send("honest", 255):
    pass
wait(lambda: server.ask("/v1/jobs/1")[1]["stage"] == "done", "the end", server.process, server.log)
assert os.path.exists(frame) and set(pixels(frame)[1]) == {255}, "%s has the liar's pixels" % os.path.relpath(frame, WORK)
