# SPDX-License-Identifier: AGPL-3.0-or-later
"""Client and worker by hand: a job of a scene with nothing in it, and strips whose pixels are the test's own."""
import hashlib
import json
import struct
import zlib

SCENE = b"camera { }\n"
HELLO = {"id": "a-worker-of-mine", "name": "mine", "slots": 1, "povray": "3.7", "probe": ""}
ME = "/v1/workers/" + HELLO["id"]


def sha(data):
    return hashlib.sha256(data).hexdigest()


def bundle_of(files):
    """The list of these files, names and contents, and the name that it has."""
    listed = {"files": [{"bytes": len(data), "name": name, "sha256": sha(data)} for name, data in sorted(files.items())], "folder": ""}
    return listed, sha(json.dumps(listed, separators=(",", ":"), sort_keys=True).encode())


BUNDLE, BUNDLE_ID = bundle_of({"scene.pov": SCENE})
# Two frames of one strip.
JOB = {"name": "x", "bundle": BUNDLE_ID, "options": ["Input_File_Name=scene.pov"], "width": 8, "height": 4, "animation": True, "first": 1, "last": 2, "step": 1, "digits": 1,
       "format": "png", "bits": 8, "strip_rows": 4, "film_rate": 0}


def bring(ask):
    """The scene, by a server's `ask`."""
    assert ask("/v1/bundles", BUNDLE)[1]["bundle"] == BUNDLE_ID
    assert ask("/v1/files/" + sha(SCENE), raw=SCENE, method="PUT")[0] == 201


def give(ask, **changes):
    """The scene, and a job of it that is JOB but for that; its number."""
    bring(ask)
    status, answer = ask("/v1/jobs", dict(JOB, **changes))
    assert status == 201, answer
    return answer["job"]


def send(ask, lease, strip, says=None):
    """Sends a strip as what it is, or says it is; status and answer."""
    return ask("/v1/leases/%s/strip?sha256=%s&seconds=0.1" % (lease, says or sha(strip)), raw=strip, method="PUT")


def png(rows, depth=8, colours=2, more=()):
    """Rows of bytes as a PNG by its definition (ISO/IEC 15948); more chunks stand before the pixels."""
    width = len(rows[0]) * 8 // (depth * {0: 1, 2: 3, 4: 2, 6: 4}[colours])
    head = struct.pack(">IIBBBBB", width, len(rows), depth, colours, 0, 0, 0)
    chunks = [(b"IHDR", head), *more, (b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)
