# SPDX-License-Identifier: AGPL-3.0-or-later
"""Two hundred simulated workers at once, each strip real to the server: none is lost, none counted twice, and the server's CPU time a strip stays small.
bench/farm measures the same with thousands."""
import json
import os
import re
import signal
import sqlite3
import subprocess

from farm import BIN, ENV, WORK, Server, bhfarm, pixels, wait

with open(WORK + "/token", "w") as f:
    f.write(bhfarm("token", "new").stdout)
token = open(WORK + "/token").read().strip()
server = Server("--token-file", WORK + "/token")


def cpu():
    fields = open("/proc/%d/stat" % server.process.pid).read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


# Strips of 20 kB: 200 x 8 s / 2 s, that is up to 800 of them.
before = cpu()
done = subprocess.run([BIN + "/farm_crowd", "--server", server.url[len("http://"):], "--token-file", WORK + "/token", "--workers", "200", "--strip-ms", "2000", "--seconds", "8",
                       "--ramp", "1", "--width", "320", "--rows", "64"], env=ENV, capture_output=True, text=True)
assert done.returncode == 0, done.stderr + done.stdout
seen = json.loads(done.stdout)
spent = cpu() - before
assert seen["errors"] == 0 and seen["empty"] == 0, seen
assert seen["accepted"] >= 200, "fewer strips than workers: %s" % seen # even on a busy machine
# Each answer that says so stands in the ledger, once; what the server did after the crowd's end may be there too.
wait(lambda: server.ask("/v1/jobs/1", token=token)[1]["frames_done"] > 0, "a frame", seconds=30)
job = server.ask("/v1/jobs/1", token=token)[1]
server.process.send_signal(signal.SIGTERM)
assert server.process.wait(30) == 0
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
# Measured: 1.8 to 2.5 ms a strip on a busy machine. Five times that would not do for 2,000 workers.
assert spent / len(reports) < 0.012, "%.1f ms of CPU a strip" % (1000 * spent / len(reports))
print("%d strips of 200 workers, %.2f ms of the server's CPU each, idle %.2f %%" % (len(reports), 1000 * spent / len(reports), 100 * seen["idle"]))
