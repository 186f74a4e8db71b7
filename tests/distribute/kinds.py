# SPDX-License-Identifier: AGPL-3.0-or-later
"""A worker that sends strips of another colour type than the job's others have: they could not be joined, so they are refused when they come, and the film ends.
kinds.py BIN"""
import json

from farm import Server, wait
from hand import HELLO, ME, give, png, send

WIDTH, ROWS = 8, 2
server = Server("--lease", "3600")
give(server.ask, width=WIDTH, height=2 * ROWS, animation=False, first=0, last=0, digits=0, strip_rows=ROWS)
assert server.ask("/v1/workers", HELLO)[0] == 201


def report(colour_type):
    """Black rows: 2 is RGB, 6 has alpha."""
    lease = server.ask(ME + "/take", {"wait": 60})[1]["lease"]
    return send(server.ask, lease, png([bytes(WIDTH * {2: 3, 6: 4}[colour_type])] * ROWS, colours=colour_type))[0]


assert report(2) == 200
assert report(6) == 200 # the lease has ended by it, as by any failure
lines = json.dumps(server.ask("/v1/jobs/1/log")[1])
assert "it is PNG's colour type 6" in lines and "the job's others are PNG's colour type 2" in lines, lines
assert report(2) == 200
wait(lambda: server.ask("/v1/jobs/1")[1]["stage"] == "done", "the end", server.process, server.log)
