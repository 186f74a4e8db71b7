# SPDX-License-Identifier: AGPL-3.0-or-later
"""One run of faults.py: what happens when, and what must be true in the end."""
import os
import random
import re
import shutil
import signal
import sys
import time
import urllib.error

from farm import BIN, PATIENCE, WORK, bare, bhfarm, frames_in, pictures, povray, same, scene, wait
import fault_check
from fault_lab import Lab, Worker
from fault_proxy import Proxy
from fault_rogue import Rogue
from hand import JOB, give, png

SPEC = dict(JOB, width=32, height=40, last=10, digits=2, bits=16, strip_rows=2, film_rate=25, client_key="one")
PER = SPEC["height"] // SPEC["strip_rows"]
MISDEEDS = ("vanish", "late", "foreign", "double", "double", "truncated", "corrupt", "half", "nonsense")
LIAR = """#!/bin/bash
grep -q probe.pov "$POVINI" || sed -i 's/^Subset_\\(Start\\|End\\)_Frame=.*/Subset_\\1_Frame='$(grep -q Frame=3$ "$POVINI" && echo 5 || echo 3)/ "$POVINI"
exec %s "$@"
"""
SLEEPER = '#!/bin/bash\n[ "$1" = --version ] || grep -q probe.pov "$POVINI" || exec sleep 36000\nexec %s "$@"\n'


def schedule(seed):
    """When what happens to whom, for how long: (seconds since the start, what, whom, seconds)."""
    dice, at, plan = random.Random(seed), 0.3, []
    while at < 7:
        what = dice.choices(("kill worker", "kill server", "fill server", "fill worker", "freeze worker", "freeze server", "net", "rogue"), (5, 3, 2, 1, 1, 1, 4, 7))[0]
        whom = {"net": dice.choice(("slow", "cut", "deaf", "dead")), "rogue": dice.choice(MISDEEDS)}.get(what, dice.randrange(4))
        plan.append((at, what, whom, dice.uniform(0.1, 1.5)))
        at += dice.uniform(0.05, 0.6)
    return plan


def program(name, text=None):
    """A povray of that character: the stand-in under that name, or a script around the real one."""
    place = WORK + "/bin-" + name + "/" + name
    os.makedirs(os.path.dirname(place))
    if text is None:
        os.symlink(BIN + "/standin", place)
    else:
        with open(place, "w") as f:
            f.write(text % (BIN + "/povray"))
        os.chmod(place, 0o755)
    return place


def strip_file(whole, first, rows, lie):
    """A strip as a good worker cuts it from a picture, or with other pixels."""
    with open(whole, "rb") as f:
        (_, height, depth, colours), chunks, raw = pictures.unpacked_png(f.read())
    row = len(raw) // height
    body = [bytes(b ^ (255 if lie else 0) for b in raw[y * row:(y + 1) * row]) for y in range(first, first + rows)]
    return png(body, depth, colours, [(kind.encode(), data) for kind, data in chunks.items() if kind in ("gAMA", "sRGB")])


class Run:
    def __init__(self, seed):
        self.real = seed % 10 == 0
        self.seed, self.counts = seed, {}
        self.lab = Lab()
        self.proxy = Proxy(seed, self.lab.server)
        self.reference = WORK + "/reference"
        os.makedirs(self.reference)
        if self.real:
            good, liar, sleeper = BIN + "/povray", program("liar", LIAR), program("sleeper", SLEEPER)
            ini = scene(WORK + "/scene", frames=10, width=SPEC["width"], height=SPEC["height"], ini="Output_File_Name=x")
            povray(ini, WORK + "/scene", "+O" + self.reference + "/x")
            self.job = int(bhfarm("submit", ini, "--strips", str(PER), server=self.lab.server).stdout)
        else:
            good, liar, sleeper = program("good"), program("liar"), program("sleeper")
            for frame in range(1, 11):
                bare(self.frame(frame), SPEC["width"], SPEC["height"], frame, good)
            self.job = give(self.lab.server.ask, **dict(SPEC, options=SPEC["options"] + ["Declare=pause=60"]))
        rows = SPEC["strip_rows"]
        self.truth = [fault_check.digest(self.frame(f), y, rows) for f in range(1, 11) for y in range(0, SPEC["height"], rows)]
        self.others = [Worker("liar", liar, self.proxy, False), Worker("full", good, self.proxy, False)]
        self.workers = [Worker("good%d" % i, good, self.proxy) for i in range(3)] + [Worker("sleeper", sleeper, self.proxy)]
        full = self.others[1]
        wait(lambda: "at work" in open(full.log).read(), "the worker whose disk is to be full", full.process, full.log)
        full.disk.fill()
        wait(lambda: "probe" in self.proxy.hello, "the first worker", log=self.lab.server.log)
        self.rogue = Rogue(seed, self.lab.server, lambda task, lie: strip_file(self.frame(task["frame"]), task["row"], task["rows"], lie), self.proxy.hello)

    def frame(self, number):
        return "%s/x%02d.png" % (self.reference, number)

    def happen(self, what, whom, seconds):
        """A fault; returns what ends it after that time, if anything must."""
        self.counts[what.split()[0]] = self.counts.get(what.split()[0], 0) + 1
        lab, worker = self.lab, self.workers[whom] if isinstance(whom, int) else None
        if what == "kill worker":
            worker.kill(seconds / 2)
        elif what == "kill server":
            lab.kill(seconds / 2)
            self.look()
        elif what == "fill server":
            lab.disk.fill()
            return lab.disk.empty
        elif what == "fill worker":
            worker.disk.fill()
            return worker.disk.empty
        elif what == "freeze worker":
            worker.freeze(True)
            return lambda: worker.freeze(False)
        elif what == "freeze server":
            if lab.server.process.poll() is None:
                lab.server.process.send_signal(signal.SIGSTOP)
            return lambda: lab.server.process.poll() is None and lab.server.process.send_signal(signal.SIGCONT)
        elif what == "net":
            self.proxy.mood = whom
            return self.calm
        elif what == "rogue":
            self.rogue.deeds.put(whom)
        return None

    def calm(self):
        self.proxy.mood = "calm"

    def look(self):
        if os.path.exists(self.lab.server.spool + "/ledger.sqlite"):
            fault_check.check_killed(self.lab.server.spool, self.rogue.kept, SPEC)

    def state(self):
        try:
            return self.lab.server.ask("/v1/jobs/%d" % self.job)[1]
        except (urllib.error.URLError, OSError):
            return {}

    def go(self):
        """Faults by the schedule; then until the job is done."""
        began, plan, ends, job, shown = time.monotonic(), schedule(self.seed), [], {}, 0
        while True:
            now = time.monotonic() - began
            while plan and plan[0][0] <= now:
                at, what, whom, seconds = plan.pop(0)
                if end := self.happen(what, whom, seconds):
                    ends.append((now + seconds, end))
            for end in [e for e in ends if e[0] <= now]:
                end[1]()
                ends.remove(end)
            for one in [self.lab, *self.workers, *self.others]:
                one.mend()
                assert not one.crash, one.crash
            assert not self.rogue.found, self.rogue.found
            if not plan and not ends:
                job = self.state()
                assert job.get("stage", "running") == "running" or job["stage"] == "done", job
                if job.get("stage") == "done":
                    return now
                assert now < PATIENCE, "not done: %s\n%s" % (job, self.said()[-3000:])
            if int(now) > shown and "FAULTS_SHOW" in os.environ:
                print("%3d s, %s: %s" % (now, self.proxy.mood, self.state()), file=sys.stderr, flush=True)
            shown = int(now)
            time.sleep(0.02)

    def said(self):
        return open(self.lab.server.log).read()

    def judge(self):
        """What must be true now that the job is done."""
        out = WORK + "/out"
        bhfarm("fetch", str(self.job), "--to", out, server=self.lab.server)
        for frame in range(1, 11):
            same("%s/x%02d.png" % (out, frame), self.frame(frame))
        assert frames_in(out + "/x.mp4") == 10
        log = self.said()
        assert "worker liar is set aside: its pixels" in log, "the liar was not named\n" + log[-3000:]
        assert not re.search("worker (good|full|sleeper)[0-9]* is set aside", log), log
        assert not re.search("terminate called|Assertion|while answering", log), log
        for worker in self.workers + self.others:
            worker.freeze(False)
            worker.kill(1e9)
        self.lab.server.process.terminate()
        assert self.lab.server.process.wait(PATIENCE) == 0
        fault_check.check_done(self.lab.server.spool, self.job, SPEC, self.truth)


def main(seed):
    run = Run(seed)
    try:
        seconds = run.go()
        run.judge()
    except BaseException:
        print("".join("%6.2f s %s %s, %.2f s\n" % f for f in schedule(seed)), end="")
        if os.environ.get("FAULTS_KEEP"):
            shutil.copytree(WORK, os.environ["FAULTS_KEEP"], symlinks=True)
        raise
    run.counts["cut"] = run.proxy.cuts
    print("seed %d done seconds=%.1f %s" % (seed, seconds, " ".join("%s=%d" % c for c in sorted(run.counts.items()))))
