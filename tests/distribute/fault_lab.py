# SPDX-License-Identifier: AGPL-3.0-or-later
"""The lab of a fault test: a server, workers good and bad, disks that can be filled. Whoever dies is started again, as an init system would."""
import os
import signal
import subprocess
import time

from farm import BIN, ENV, WORK, Server, start

HELP = subprocess.run([BIN + "/bhfarm-worker", "--help"], capture_output=True, text=True).stdout
SANDBOX = ["--no-sandbox"] if "--no-sandbox" in HELP else [] # a stand-in in a sandbox would test the sandbox


class Disk:
    """A small tmpfs, if this process may mount one."""
    def __init__(self, folder, megabytes):
        os.makedirs(folder)
        self.folder, self.filler = folder, folder + "/filler"
        self.small = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=%dm" % megabytes, "none", folder], capture_output=True).returncode == 0

    def fill(self):
        if not self.small:
            return
        with open(self.filler, "ab", buffering=0) as f:
            try:
                while True:
                    f.write(b"x" * 65536)
            except OSError:
                pass
        with open(self.filler, "ab", buffering=0) as f:
            try:
                while True:
                    f.write(b"x")
            except OSError:
                pass

    def empty(self):
        if os.path.exists(self.filler):
            os.remove(self.filler)


class Worker:
    """`fragile`: may be killed. `where`: the disk with its scene cache and scratch."""
    def __init__(self, name, povray, proxy, fragile=True):
        self.name, self.povray, self.proxy, self.fragile = name, povray, proxy, fragile
        self.disk = Disk(WORK + "/disk-" + name, 8)
        self.log = WORK + "/" + name + ".log"
        self.process, self.due, self.starts, self.crash = None, 0, 0, ""
        self.start()

    def start(self):
        self.starts += 1
        ENV["TMPDIR"] = self.disk.folder
        self.process = start("bhfarm-worker", "--server", "http://127.0.0.1:%d" % self.proxy.port, "--slots", "1", "--name", self.name, "--nice", "0",
                             "--cache", self.disk.folder + "/cache", "--povray", self.povray, *SANDBOX, log=self.log)
        ENV.pop("TMPDIR")

    def kill(self, after):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.due = time.monotonic() + after

    def mend(self):
        """Starts it again when it is due. One that ended by itself was not able to start, and says so; anything else is a crash."""
        code = self.process.poll()
        if code is None:
            return
        if not self.due:
            if code != 1:
                self.crash = "worker %s ended with %s" % (self.name, code)
            self.due = time.monotonic() + 0.3
        if time.monotonic() >= self.due:
            self.due = 0
            self.start()

    def freeze(self, frozen):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGSTOP if frozen else signal.SIGCONT)


class Lab:
    """The server, on a disk of its own."""
    def __init__(self, *words):
        self.disk = Disk(WORK + "/disk-server", 16)
        self.server = Server("--lease", "1", *words, spool=self.disk.folder + "/spool", log=WORK + "/server.log")
        self.due, self.starts, self.crash = 0, 1, ""

    def kill(self, after):
        if self.server.process.poll() is None:
            self.server.process.kill()
            self.server.process.wait()
        self.due = time.monotonic() + after

    def start(self):
        s = self.server
        self.starts += 1
        s.process = start("bhfarm-server", "--listen", "%s:%d" % (s.host, s.port), "--spool", s.spool, *s.words, log=s.log)

    def mend(self):
        """Likewise; on a full disk it cannot start, says so in one line, and is started again."""
        code = self.server.process.poll()
        if code is None:
            return
        if not self.due:
            if code != 1:
                self.crash = "the server ended with %s" % code
            self.due = time.monotonic() + 0.2
        if time.monotonic() >= self.due:
            self.due = 0
            self.start()
