# SPDX-License-Identifier: AGPL-3.0-or-later
"""Two hundred simulated workers at once, each strip real to the server: none is lost, none counted twice, and the server's CPU time a strip stays a small multiple of what
looking at a strip takes.
bench/farm measures the same with thousands."""
import hashlib
import json
import os
import re
import signal
import sqlite3
import subprocess
import time
import zlib

from farm import BIN, ENV, PATIENCE, WORK, Server, bhfarm, pixels, wait

with open(WORK + "/token", "w") as f:
    f.write(bhfarm("token", "new").stdout)
token = open(WORK + "/token").read().strip()
server = Server("--token-file", WORK + "/token")


def cpu():
    fields = open("/proc/%d/stat" % server.process.pid).read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


# Strips of 20 kB, three for each worker.
before = cpu()
done = subprocess.run([BIN + "/farm_crowd", "--server", server.url[len("http://"):], "--token-file", WORK + "/token", "--workers", "200", "--strip-ms", "2000", "--strips", "600", "--seconds", str(PATIENCE),
                       "--ramp", "1", "--width", "320", "--rows", "64"], env=ENV, capture_output=True, text=True)
assert done.returncode == 0, done.stderr + done.stdout
seen = json.loads(done.stdout)
spent = cpu() - before
assert seen["errors"] == 0 and seen["empty"] == 0, seen
assert seen["accepted"] >= 600, seen
# Each answer that says so stands in the ledger, once; what the server did after the crowd's end may be there too.
wait(lambda: server.ask("/v1/jobs/1", token=token)[1]["frames_done"] > 0, "a frame", server.process, server.log)
job = server.ask("/v1/jobs/1", token=token)[1]
server.process.send_signal(signal.SIGTERM)
assert server.process.wait(PATIENCE) == 0
ledger = sqlite3.connect(server.spool + "/ledger.sqlite")
reports = ledger.execute("SELECT strip, worker, settled FROM report").fetchall()
assert ledger.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
assert seen["accepted"] <= len(reports) <= seen["sent"], (seen["accepted"], len(reports), seen["sent"])
settled = {strip for strip, _, is_settled in reports if is_settled}
files = os.listdir(server.spool + "/jobs/1/strips")
assert {int(re.match(r"(\d+)-", name).group(1)) for name in files} >= {strip for strip, _, _ in reports}, "a row without its file"
assert len(settled) >= job["strips_done"] > 0, (len(settled), job["strips_done"])
# The frames that are there have every row that was sent.
frame = next(iter(sorted(os.listdir(server.spool + "/jobs/1/frames"))))
strip = server.spool + "/jobs/1/strips/" + files[0]
assert pixels(server.spool + "/jobs/1/frames/" + frame)[1] == 8 * pixels(strip)[1], frame
# What looking at them takes here: unpacked, and hashed as they are and as pixels.
with open(strip, "rb") as f:
    data = f.read()
before = time.process_time()
for _ in reports:
    at, rows = data.index(b"IDAT"), zlib.decompressobj()
    hashlib.sha256(data).digest(), hashlib.sha256(rows.decompress(data[at + 4:])).digest()
looked = time.process_time() - before
# Measured: 8 to 14 times as much, busy or not. Five times that would not do for 2,000 workers.
assert spent < 50 * looked, "%.1f times what looking at the strips takes" % (spent / looked)
print("%d strips of 200 workers, %.2f ms of the server's CPU each, %.1f times what looking at them takes; idle %.2f %%"
      % (len(reports), 1000 * spent / len(reports), spent / looked, 100 * seen["idle"]))
