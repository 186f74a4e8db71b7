# SPDX-License-Identifier: AGPL-3.0-or-later
"""A job of 200 strips while everything goes wrong, by a seed; in the end the frames have the pixels of one povray's, and the ledger is in order.
   faults.py BIN SEED       one run; the same seed has the same schedule of faults. One in ten renders a black hole with the real povray, the others have a stand-in
   faults.py BIN A-B [-jN]  runs from A to B, N at once; each that fails is named"""
import concurrent.futures
import ctypes
import os
import signal
import subprocess
import sys
import time

ONE_AT_MOST = 900 # seconds


def once(seed):
    """In a mount namespace of its own, so that small disks go with the test: as root, or as root of a user namespace."""
    for way in (["unshare", "-m"], ["unshare", "-Urm"], []):
        if not way or subprocess.run([*way, "true"], capture_output=True).returncode == 0:
            words = [*way, sys.executable, os.path.abspath(__file__), sys.argv[1], str(seed), "inside"]
            run = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            try:
                out, err = run.communicate(timeout=ONE_AT_MOST)
            except subprocess.TimeoutExpired:
                run.terminate() # it ends its servers and workers
                out, err = run.communicate()
                err += "not over after %d s" % ONE_AT_MOST
            return run.returncode, out, err


def many(first, last, jobs):
    began, bad, totals = time.monotonic(), [], {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for seed, (code, out, err) in zip(range(first, last + 1), pool.map(once, range(first, last + 1))):
            if code:
                bad.append(seed)
                print("seed %d FAILED; 'faults.py BIN %d' does it again\n%s" % (seed, seed, (out + err)[-6000:]), flush=True)
            for word in out.split("\n")[-2].split()[3:] if not code else []:
                name, number = word.split("=")
                totals[name] = totals.get(name, 0) + float(number)
    print("%d runs, %d failed%s, %.0f s: %s" % (last - first + 1, len(bad), " (%s)" % bad if bad else "", time.monotonic() - began,
                                                ", ".join("%s %.0f" % (n, v) for n, v in totals.items())))
    return 1 if bad else 0


if __name__ == "__main__":
    if "inside" in sys.argv:
        ctypes.CDLL(None).prctl(1, signal.SIGTERM) # PR_SET_PDEATHSIG: nothing is left when the one that started it dies
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
        import fault_run
        fault_run.main(int(sys.argv[2]))
    elif "-" in sys.argv[2]:
        first, last = map(int, sys.argv[2].split("-"))
        sys.exit(many(first, last, int(sys.argv[3][2:]) if len(sys.argv) > 3 else 2 * (os.cpu_count() or 1)))
    else:
        code, out, err = once(int(sys.argv[2]))
        print(out + err, end="")
        sys.exit(code)
