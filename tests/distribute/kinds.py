# SPDX-License-Identifier: AGPL-3.0-or-later
"""A worker that sends strips of another colour type than the job's others have: they could not be joined, so they are refused when they come, and the film ends.
kinds.py BIN"""
import hashlib
import json
import struct
import time
import zlib

from farm import Server

WIDTH, ROWS = 8, 2
ME = "/v1/workers/a-worker-of-mine"
SCENE = b"camera { }\n"
SHA = hashlib.sha256(SCENE).hexdigest()


def png(colour_type):
    """Black rows as a picture of their own: 2 is RGB, 6 has alpha."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = (b"\0" + bytes(WIDTH * {2: 3, 6: 4}[colour_type])) * ROWS
    header = struct.pack(">IIBBBBB", WIDTH, ROWS, 8, colour_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


server = Server()
bundle = {"files": [{"bytes": len(SCENE), "name": "scene.pov", "sha256": SHA}], "folder": ""}
assert server.ask("/v1/bundles", bundle)[0] == 201
assert server.ask("/v1/files/" + SHA, raw=SCENE, method="PUT")[0] == 201
job = {"name": "x", "bundle": hashlib.sha256(json.dumps(bundle, separators=(",", ":"), sort_keys=True).encode()).hexdigest(), "options": ["Input_File_Name=scene.pov"],
       "width": WIDTH, "height": 2 * ROWS, "animation": False, "first": 0, "last": 0, "step": 1, "digits": 0, "format": "png", "bits": 8, "strip_rows": ROWS, "film_rate": 0}
assert server.ask("/v1/jobs", job)[1] == {"job": 1}
assert server.ask("/v1/workers", {"id": "a-worker-of-mine", "name": "odd", "slots": 1, "povray": "3.7", "probe": ""})[0] == 201


def send(colour_type):
    lease, strip = server.ask(ME + "/take", {"wait": 5})[1]["lease"], png(colour_type)
    return server.ask("/v1/leases/%d/strip?sha256=%s&seconds=1" % (lease, hashlib.sha256(strip).hexdigest()), raw=strip, method="PUT")


assert send(2)[0] == 200
assert send(6)[0] == 200 # the lease has ended by it, as by any failure
lines = json.dumps(server.ask("/v1/jobs/1/log")[1])
assert "it is PNG's colour type 6" in lines and "the job's others are PNG's colour type 2" in lines, lines
assert send(2)[0] == 200
end = time.monotonic() + 60
while server.ask("/v1/jobs/1")[1]["stage"] != "done":
    assert time.monotonic() < end, server.ask("/v1/jobs/1")
    time.sleep(0.05)
