# SPDX-License-Identifier: AGPL-3.0-or-later
"""Our povray starts, renders next to nothing and ends within a tenth of a second: POV-Ray's own way from one state to the next is sleep after sleep, 0.65 seconds of them."""
import subprocess
import time

from farm import BIN, ENV, WORK

with open(WORK + "/trivial.pov", "w") as f:
    f.write("#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location -5*z look_at 0 }\nsphere { 0, 1 pigment { rgb 1 } }\nlight_source { <9, 9, -9> rgb 1 }\n")
with open(WORK + "/empty.ini", "w") as f:
    f.write("Verbose=Off\n")
times = []
for tries in range(100): # sleeps are there each time; what other processes take is not
    start = time.monotonic()
    subprocess.run([BIN + "/povray", "+I" + WORK + "/trivial.pov", "+W64", "+H48", "-D", "+WT1", "+O" + WORK + "/trivial.png"], env=dict(ENV, POVINI=WORK + "/empty.ini"),
                   capture_output=True, check=tries > 90)
    times.append(time.monotonic() - start)
    if times[-1] < 0.1:
        break
assert min(times) < 0.1, "the least of %d runs took %.3f s" % (len(times), min(times))
print("%.3f s, run %d" % (times[-1], len(times)))
