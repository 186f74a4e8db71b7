# SPDX-License-Identifier: AGPL-3.0-or-later
"""Our povray starts, renders next to nothing and ends, and sleeps for less than a tenth of a second of that: POV-Ray's own way
from one state to the next is sleep after sleep, 0.65 seconds of them."""
import math
import resource
import subprocess
import time

from farm import BIN, ENV, WORK

with open(WORK + "/trivial.pov", "w") as f:
    f.write("#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location -5*z look_at 0 }\nsphere { 0, 1 pigment { rgb 1 } }\nlight_source { <9, 9, -9> rgb 1 }\n")
with open(WORK + "/empty.ini", "w") as f:
    f.write("Verbose=Off\n")


def run():
    """Seconds by the clock, and by the processors' clocks."""
    start, used = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([BIN + "/povray", "+I" + WORK + "/trivial.pov", "+W64", "+H48", "-D", "+WT1", "+O" + WORK + "/trivial.png"], env=dict(ENV, POVINI=WORK + "/empty.ini"),
                          capture_output=True)
    took, now = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.returncode, took, now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime


def work(seconds):
    """How long this machine takes, now, to give a process that never sleeps so much of a processor."""
    start, used = time.monotonic(), time.process_time()
    while time.process_time() - used < seconds:
        pass
    return time.monotonic() - start


slept = []
for tries in range(100): # sleeps are there each time; what other processes take is not
    code, took, cpu = run()
    slept.append(took - work(cpu) if code == 0 else math.inf)
    if slept[-1] < 0.1:
        break
assert min(slept) < 0.1, "the least of %d runs slept for %.3f s" % (len(slept), min(slept))
print("%.3f s, %.3f s of them asleep, run %d" % (took, slept[-1], len(slept)))
