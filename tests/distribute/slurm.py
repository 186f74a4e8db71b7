# SPDX-License-Identifier: AGPL-3.0-or-later
"""bhfarm slurm on a real slurmctld, slurmd and munge: a worker is requeued at work, one gets TERM, one comes to its time limit; the film has the pixels
of a bare povray, and the others leave when there is nothing to do. Needs root: slurmd starts jobs for others."""
import os
import signal
import socket
import subprocess
import sys
import time

from farm import BIN, ENV, PATIENCE, WORK, Gate, Server, bhfarm, povray, running, same, scene, wait

DAEMONS = ["/usr/sbin/munged", "/usr/sbin/slurmctld", "/usr/sbin/slurmd"]
if os.geteuid() != 0 or not all(os.path.exists(d) for d in DAEMONS):
    print("skipped: not root, or no slurmctld, slurmd and munge here")
    sys.exit(77)

os.umask(0o022) # munge wants all to reach its socket
os.chmod(WORK, 0o711)
HOST = socket.gethostname().split(".")[0]
SLURM = WORK + "/slurm"
for folder in ("state", "spool", "munge", "logs"):
    os.makedirs(SLURM + "/" + folder, mode=0o755)
with open(SLURM + "/munge/key", "wb") as f:
    f.write(os.urandom(64))
os.chmod(SLURM + "/munge/key", 0o600)


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


# A job that was requeued rests for cred_expire seconds. Cores that are not there do no harm: workers wait for each other a little.
CONFIG = """ClusterName=farm
SlurmctldHost={host}(127.0.0.1)
AuthInfo=socket={slurm}/munge/socket,cred_expire=10
SlurmctldPort={control}
SlurmdPort={node}
SlurmUser=root
StateSaveLocation={slurm}/state
SlurmdSpoolDir={slurm}/spool
SlurmctldPidFile={slurm}/slurmctld.pid
SlurmdPidFile={slurm}/slurmd.pid
MailProg=/bin/true
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MinJobAge=86400
KillWait=30
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=8
PartitionName=lab Nodes=ALL Default=YES MaxTime=10
"""


def daemon(*words):
    with open(SLURM + "/logs/" + os.path.basename(words[0]), "w") as log:
        p = subprocess.Popen(words, env=ENV, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
    running.append(p)
    return p


def slurm(*words):
    done = subprocess.run(words, env=ENV, capture_output=True, text=True)
    assert done.returncode == 0, (words, done.stderr)
    return done.stdout


def cluster():
    """The daemons, once the node is idle; with other ports should somebody else have taken one meanwhile."""
    for tries in range(5):
        with open(SLURM + "/slurm.conf", "w") as f:
            f.write(CONFIG.format(host=HOST, slurm=SLURM, control=free_port(), node=free_port()))
        daemons = [daemon(DAEMONS[1], "-D", "-i"), daemon(DAEMONS[2], "-D")]
        until = time.monotonic() + PATIENCE / 10
        while time.monotonic() < until and all(d.poll() is None for d in daemons):
            if "idle" in subprocess.run(["sinfo", "-h", "-o", "%t"], env=ENV, capture_output=True, text=True).stdout:
                return daemons
            time.sleep(0.1)
        for d in daemons:
            d.kill()
            d.wait()
    sys.exit("Slurm does not start: " + open(SLURM + "/logs/slurmctld").read()[-2000:] + open(SLURM + "/logs/slurmd").read()[-2000:])


def refused(text, *words, **changes):
    done = subprocess.run([BIN + "/bhfarm", "slurm", *words], env=dict(ENV, **changes), cwd=WORK, capture_output=True, text=True)
    lines = done.stderr.strip().split("\n")
    assert done.returncode == 1 and len(lines) == 1 and text in lines[0] and not done.stdout, (words, done)


with open(WORK + "/token", "w") as f:
    f.write(bhfarm("token", "new").stdout)
os.chmod(WORK + "/token", 0o600)
server = Server("--token-file", WORK + "/token", "--lease", "5")
ENV["BHFARM_SERVER"] = server.url
ENV["BHFARM_TOKEN_FILE"] = WORK + "/token"

# Without Slurm: none of its commands; then one that says that its only node is this machine, or another.
os.makedirs(WORK + "/bin")
refused("this machine alone", "--workers", "1", PATH=WORK + "/bin")
for node, text in ((HOST, "there is no sbatch here"), ("elsewhere", "Slurm's node elsewhere cannot reach the server at " + server.url)):
    with open(WORK + "/bin/sinfo", "w") as f:
        f.write("#!/bin/sh\necho %s\n" % node)
    os.chmod(WORK + "/bin/sinfo", 0o755)
    refused(text, "--workers", "1", PATH=WORK + "/bin")
refused("Slurm's node elsewhere cannot", "--workers", "1", "--server", "http://0.0.0.0:7700", PATH=WORK + "/bin")

ENV["SLURM_CONF"] = SLURM + "/slurm.conf"
munged = daemon(DAEMONS[0], "--foreground", "--key-file", SLURM + "/munge/key", "--socket", SLURM + "/munge/socket", "--pid-file", SLURM + "/munge/pid",
                "--log-file", SLURM + "/munge/log", "--seed-file", SLURM + "/munge/seed")
wait(lambda: os.path.exists(SLURM + "/munge/socket"), "munge", munged, SLURM + "/logs/munged")
daemons = cluster()

refused("--workers is ''", "--dry-run")
refused("--workers is '0'", "--workers", "0")
refused("--workers is 'two'", "--workers", "two")
refused("--partition is 'a b'", "--workers", "1", "--partition", "a b")
refused("what is 'lab'?", "--workers", "1", "lab")
refused("sbatch says: ", "--workers", "1", "--partition", "nosuch")
refused("sbatch says: Invalid --time", "--workers", "1", "--time", "noon")
refused("sbatch says: ", "--workers", "1", "--", "--nosuch")
refused("token", "--workers", "1", BHFARM_TOKEN_FILE="/dev/null")
refused("no answer from", "--workers", "1", "--server", "127.0.0.1:1")
assert slurm("squeue", "-h") == ""

ini = scene(WORK + "/scene", frames=3, width=160, height=320)
os.makedirs(WORK + "/reference")
povray(ini, WORK + "/scene", "+O" + WORK + "/reference/film")
number = int(bhfarm("submit", ini, "--strips", "10", "--video", "none").stdout)

logs = ["--", "--output", WORK + "/slurm-%a-%j.log"]
gate = Gate()
ENV["BHFARM_POVRAY"] = gate.povray
words = ["slurm", "--workers", "2", "--no-sandbox", "--idle-exit", "3", "--cache", WORK + "/it's a cache"]
script = bhfarm(*words, "--dry-run").stdout
assert script.startswith("#!/bin/bash\n#SBATCH ") and "\nexec '%s/bhfarm-worker'" % BIN in script, script
array = bhfarm(*words, *logs, cwd=WORK).stdout.strip()
limited = bhfarm("slurm", "--workers", "1", "--no-sandbox", "--idle-exit", "600", "--time", "1", "--grace", "5", "--cache", WORK + "/cache", *logs, cwd=WORK).stdout.strip()
assert array.isdigit() and limited.isdigit()


def workers():
    return {w["name"]: w for w in server.ask("/v1/workers", token=TOKEN)[1]["workers"]}


def job():
    return server.ask("/v1/jobs/%d" % number, token=TOKEN)[1]


def of_slurm(which, what):
    found = [w.split("=", 1)[1] for w in slurm("scontrol", "-o", "show", "job", which).split() if w.startswith(what + "=")]
    return found[0] if found else ""


TOKEN = open(WORK + "/token").read().strip()
one, two = HOST + "-1", HOST + "-2"
wait(lambda: one in workers() and workers()[one]["busy"], "the array's first worker at work", log=SLURM + "/logs/slurmctld")
slurm("scontrol", "requeue", array + "_1")
wait(lambda: two in workers() and workers()[two]["busy"], "the array's second worker at work", log=SLURM + "/logs/slurmctld")
slurm("scancel", "--batch", "--signal=TERM", array + "_2")
gate.open()
wait(lambda: of_slurm(array + "_2", "JobState") == "COMPLETED", "the worker that got TERM", log=SLURM + "/logs/slurmd")
wait(lambda: job()["stage"] == "done", "the film", log=server.log)
bhfarm("fetch", str(number), "--to", WORK + "/out")
for frame in (1, 2, 3):
    same("%s/out/film%d.png" % (WORK, frame), "%s/reference/film%d.png" % (WORK, frame))
assert server.ask("/v1/jobs/%d/log" % number, token=TOKEN)[1]["failures"] == []

wait(lambda: of_slurm(array + "_1", "Restarts") == "1" and of_slurm(array + "_1", "JobState") == "COMPLETED", "the requeued worker to come back and leave",
     log=SLURM + "/logs/slurmd")
assert of_slurm(array + "_1", "ExitCode") == "0:0"
wait(lambda: of_slurm(limited, "JobState") != "RUNNING", "the time limit", log=SLURM + "/logs/slurmctld")
assert of_slurm(limited, "JobState") == "COMPLETED" and of_slurm(limited, "ExitCode") == "0:0", of_slurm(limited, "JobState")
wait(lambda: workers() == {}, "the workers to be gone")
for d in (daemons[1], daemons[0], munged):
    d.send_signal(signal.SIGTERM)
    assert d.wait(PATIENCE) == 0
print("30 strips; requeued, told to end, at the limit: the same pixels, and all left")
