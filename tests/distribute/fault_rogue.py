# SPDX-License-Identifier: AGPL-3.0-or-later
"""A client that speaks the protocol and means no good: late, double, truncated, corrupt and foreign reports. It learns from each answer whether the server let it."""
import queue
import random
import socket
import threading
import time
import traceback
import urllib.error

from hand import send, sha


class Rogue:
    def __init__(self, seed, server, render, hello):
        """`render(task, lie)` gives a strip's picture; `hello` is what a good worker says."""
        self.random, self.server, self.render, self.hello = random.Random(seed), server, render, hello
        self.number, self.id, self.old, self.kept, self.spoilt = 0, "", [], set(), {}
        self.deeds, self.found = queue.Queue(), "" # what is to be done, one after the other; what the server should not have let it do
        threading.Thread(target=self.work, daemon=True).start()

    def work(self):
        while True:
            try:
                getattr(self, self.deeds.get())()
            except (urllib.error.URLError, OSError, ValueError): # a server that is just down, or frozen
                pass
            except Exception:
                self.found = traceback.format_exc()

    def ask(self, path, body=None, **more):
        return self.server.ask(path, body, **more)

    def put(self, lease, data, says=None):
        return send(self.ask, lease, data, says)

    def accepted(self, answer):
        return answer[0] == 200 and answer[1]["accepted"]

    def take(self):
        if not self.id or self.ask("/v1/workers/%s/heartbeat" % self.id, {"leases": []})[0] == 404 or self.aside():
            self.number += 1
            self.id = "rogue-%012d" % self.random.randrange(10 ** 12)
            assert self.ask("/v1/workers", dict(self.hello, id=self.id, name="rogue", slots=4))[0] == 201
        status, task = self.ask("/v1/workers/%s/take" % self.id, {"wait": 0})
        return task if status == 200 else None

    def aside(self):
        return any(w["id"] == self.id and w.get("aside") for w in self.ask("/v1/workers")[1]["workers"])

    def back(self, task):
        self.ask("/v1/leases/%d/return" % task["lease"], raw=b"", method="POST")
        self.old.append(task)

    def spoil(self, task):
        """Three failures are the job's end, by promise: nobody may bring about more than one a strip."""
        key = (task["frame"], task["row"])
        self.spoilt[key] = self.spoilt.get(key, 0) + 1
        return self.spoilt[key] == 1

    def vanish(self):
        """Takes a strip and says nothing more; comes late with other pixels, when somebody else has it."""
        if task := self.take():
            self.old.append(task)

    def late(self):
        for task in self.old[-5:]:
            beaten = self.ask("/v1/workers/%s/heartbeat" % self.id, {"leases": [task["lease"]]})
            if beaten[0] == 200 and task["lease"] in beaten[1]["drop"]:
                assert not self.accepted(self.put(task["lease"], self.render(task, True))), "a lease that had ended was accepted: %s" % task
                assert not self.accepted(self.ask("/v1/leases/%d/failure" % task["lease"], {"line": "rogue", "log": ""})), task

    def foreign(self):
        """Leases that are nobody's, or somebody else's: next to those it had."""
        for task in self.old[-3:] or [{"lease": 1 << 42, "rows": 2, "row": 0, "frame": 1}]:
            for lease in (task["lease"] + self.random.choice((-1, 1, 2, 7)), self.random.randrange(1, 1 << 62)):
                answer = self.put(lease, self.render(task, True))
                assert answer[0] in (200, 503, 507) and not self.accepted(answer), "a lease that it never had was accepted: %s" % (answer,)

    def double(self):
        if task := self.take():
            good = self.render(task, False)
            answer = self.put(task["lease"], good)
            if self.accepted(answer):
                self.kept.add((task["frame"], task["row"], self.id))
                assert not self.accepted(self.put(task["lease"], good)), "a second report was accepted"
                assert not self.accepted(self.put(task["lease"], self.render(task, True))), "a second report with other pixels was accepted"
            self.old.append(task)

    def truncated(self):
        if task := self.take():
            good = self.render(task, False)
            cut = good[:self.random.randrange(1, len(good))]
            answer = self.put(task["lease"], cut, sha(good))
            assert answer[0] != 200 or not self.accepted(answer), "half a strip was accepted"
            if self.spoil(task):
                self.put(task["lease"], cut) # true to its hash, and no picture: a failure
            self.back(task)

    def corrupt(self):
        if task := self.take():
            good = self.render(task, False)
            at = self.random.randrange(len(good))
            answer = self.put(task["lease"], good[:at] + bytes([good[at] ^ 85]) + good[at + 1:], sha(good))
            assert answer[0] != 200 or not self.accepted(answer), "a corrupt strip was accepted"
            self.put(task["lease"], b"", sha(good))
            self.back(task)

    def half(self):
        """A body that ends in the middle, and one that goes on for ever after its answer."""
        if task := self.take():
            good = self.render(task, False)
            s = socket.create_connection((self.server.host, self.server.port), timeout=5)
            s.sendall(b"PUT /v1/leases/%d/strip?sha256=%s HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % (task["lease"], sha(good).encode(), len(good) + 1000) + good)
            time.sleep(0.05 * self.random.random())
            s.close()
            self.back(task)

    def nonsense(self):
        if not self.id:
            return
        for path, body in (("/take", b"{\xff}"), ("/take", b'{"wait": -1}'), ("/heartbeat", b'{"leases": ["x"]}'), ("/heartbeat", b"[" * 10000)):
            status, got = self.ask("/v1/workers/%s%s" % (self.id, path), raw=body)
            assert status in (400, 404), (path, body[:20], status, got)
