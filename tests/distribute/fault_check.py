# SPDX-License-Identifier: AGPL-3.0-or-later
"""What must be true of a spool at any moment, were the power cut just then; and at a job's end."""
import hashlib
import os
import shutil
import sqlite3
import struct

from farm import WORK, pictures


def digest(name, first=0, rows=None):
    """The hash by which the ledger names a strip's pixels: of a line that says their kind, and the rows."""
    with open(name, "rb") as f:
        (_, height, depth, colours), chunks, raw = pictures.unpacked_png(f.read())
    gamma, row = chunks.get("gAMA"), len(raw) // height
    line = b"png %d %d %d\n" % (colours, depth, struct.unpack(">I", gamma)[0] if gamma else 0)
    return hashlib.sha256(line + raw[first * row:(first + (rows or height)) * row]).hexdigest()


def ledger(spool):
    """A copy of the ledger as a start after a power cut would find it."""
    copy = WORK + "/ledger-copy"
    shutil.rmtree(copy, ignore_errors=True)
    os.mkdir(copy)
    for suffix in ("", "-wal"):
        if os.path.exists(spool + "/ledger.sqlite" + suffix):
            shutil.copy(spool + "/ledger.sqlite" + suffix, copy + "/ledger.sqlite" + suffix)
    db = sqlite3.connect(copy + "/ledger.sqlite")
    assert db.execute("PRAGMA integrity_check").fetchall() == [("ok",)], "the ledger is damaged"
    assert db.execute("PRAGMA foreign_key_check").fetchall() == [], "the ledger refers to what is not there"
    return db


def check_killed(spool, kept, spec):
    """No server runs: each report of a job that goes on has its file, with those pixels; what a client was told is there."""
    db = ledger(spool)
    stage = dict(db.execute("SELECT id, stage FROM job"))
    for job, strip, pixel, settled in db.execute("SELECT job, strip, pixels, settled FROM report"):
        if stage[job] == 2: # done: its strips may be gone
            continue
        name = "%s/jobs/%d/strips/%d-%s.png" % (spool, job, strip, pixel[:16])
        assert os.path.exists(name), "a row without its file: %s" % name
        assert digest(name) == pixel, "a row whose file has other pixels: %s" % name
    for frame, row, worker in list(kept):
        strip = (frame - spec["first"]) * ((spec["height"] + spec["strip_rows"] - 1) // spec["strip_rows"]) + row // spec["strip_rows"]
        assert db.execute("SELECT 1 FROM report WHERE strip = ? AND worker = ?", (strip, worker)).fetchone(), "an acknowledged report is lost: strip %d" % strip
    for job, frame in db.execute("SELECT job, frame FROM frame"):
        per = (spec["height"] + spec["strip_rows"] - 1) // spec["strip_rows"]
        settled = db.execute("SELECT COUNT(DISTINCT strip) FROM report WHERE job = ? AND strip >= ? AND strip < ?", (job, frame * per, frame * per + per)).fetchone()[0]
        assert settled == per, "frame %d is said to be whole with %d strips" % (frame, settled)
    db.close()


def check_done(spool, job, spec, truth):
    """`truth`: each strip's hash, from the reference. Each is settled once, with those pixels; no file is left over."""
    db = ledger(spool)
    rows = db.execute("SELECT strip, COUNT(DISTINCT pixels), MIN(pixels) FROM report WHERE job = ? AND settled GROUP BY strip ORDER BY strip", (job,)).fetchall()
    assert [r[0] for r in rows] == list(range(len(truth))), "strips that are not settled: %s" % sorted(set(range(len(truth))) - {r[0] for r in rows})
    for strip, kinds, pixel in rows:
        assert kinds == 1, "strip %d is settled with %d kinds of pixels" % (strip, kinds)
        assert pixel == truth[strip], "strip %d is settled with other pixels than the reference's" % strip
    assert db.execute("SELECT COUNT(*) FROM lease WHERE job = ?", (job,)).fetchone()[0] == 0, "leases are left over"
    frames = spec["last"] - spec["first"] + 1
    assert db.execute("SELECT COUNT(*) FROM frame WHERE job = ?", (job,)).fetchone()[0] == frames
    folder = "%s/jobs/%d" % (spool, job)
    assert os.listdir(folder) == ["frames"], "left over: %s" % os.listdir(folder)
    assert len(os.listdir(folder + "/frames")) == frames + 1, os.listdir(folder + "/frames")
    assert os.listdir(spool + "/incoming") == [], "left in incoming: %s" % os.listdir(spool + "/incoming")
    db.close()
