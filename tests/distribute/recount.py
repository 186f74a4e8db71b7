# SPDX-License-Identifier: AGPL-3.0-or-later
"""Killed when two workers' reports against a third's had been committed, and what follows from them had not: the next start counts the votes, sets the third aside, and a
frame that was stitched with its strip is stitched anew. recount.py BIN"""
import os
import sqlite3

from farm import WORK, Server, pixels, wait
from hand import HELLO, give, png, send, sha

WIDTH, ROWS = 8, 2


def grey_strip(grey):
    return png([bytes([grey]) * 3 * WIDTH] * ROWS)


def name_of(grey):
    """By which the ledger names these pixels."""
    return sha(b"png 2 8 0\n" + bytes([grey]) * 3 * WIDTH * ROWS)


server = Server("--check-every", "0", "--lease", "3600")
give(server.ask, width=WIDTH, height=2 * ROWS, strip_rows=ROWS)


def take_and_send(worker, grey):
    """Whether there was a strip to send."""
    me = worker + "-" * (16 - len(worker))
    assert server.ask("/v1/workers", dict(HELLO, id=me, name=worker))[0] in (200, 201)
    status, task = server.ask("/v1/workers/%s/take" % me, {"wait": 1})
    if status == 200:
        assert send(server.ask, task["lease"], grey_strip(grey))[0] == 200
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
    f.write(grey_strip(255))
server.again()
wait(lambda: "worker liar------------ is set aside" in open(server.log).read(), "the liar to be found", server.process, server.log)
while server.ask("/v1/jobs/1")[1]["stage"] != "done":
    take_and_send("honest", 255)
assert os.path.exists(frame) and set(pixels(frame)[1]) == {255}, "%s has the liar's pixels" % os.path.relpath(frame, WORK)
