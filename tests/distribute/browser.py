# SPDX-License-Identifier: AGPL-3.0-or-later
"""Headless Chromium for tests, by the DevTools protocol over a pipe: no port, no driver, and it ends with the test, for it ends with the pipe."""
import atexit
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

KEYS = {"Escape": 27, "ArrowLeft": 37, "ArrowRight": 39}


class Browser:
    def __init__(self, width=1280, height=860):
        self.folder = tempfile.mkdtemp(prefix="farm-browser-")
        here, there = os.pipe()[::-1], os.pipe()  # ours to its 3, its 4 to ours
        program = shutil.which("chromium") or shutil.which("chromium-browser")
        assert program, "there is no chromium; tools/setup --tests installs it"
        words = [program, "--headless=new", "--remote-debugging-pipe", "--user-data-dir=" + self.folder, "--no-first-run", "--disable-gpu", "--hide-scrollbars",
                 "--disable-background-networking", "--disable-component-update", "--disable-extensions", "--disable-dev-shm-usage", "--force-color-profile=srgb"]
        if os.geteuid() == 0:
            words.append("--no-sandbox")  # it does not start as root otherwise

        def plumb():  # above 4 first, so that neither is written over
            a, b = os.dup(here[1]), os.dup(there[1])
            os.dup2(a, 3)
            os.dup2(b, 4)
        low = [os.open(os.devnull, os.O_RDONLY) for _ in range(4)]  # keeps 3 and 4 from being ours
        self.process = subprocess.Popen(words, preexec_fn=plumb, close_fds=True, pass_fds=(3, 4), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=open(self.folder + "/stderr", "w"), start_new_session=True, env=dict(os.environ, HOME=self.folder))
        atexit.register(self.close)
        for fd in (here[1], there[1], *low):
            os.close(fd)
        self.out, self.into = here[0], there[0]
        self.rest, self.number, self.session, self.events = b"", 0, None, []
        self.said = []  # what went to the console, and exceptions
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.call("Performance.enable", timeDomain="threadTicks")
        self.size(width, height)

    def close(self):
        if not self.process:
            return
        process, self.process = self.process, None
        os.close(self.out)
        os.close(self.into)
        try:
            process.wait(5)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + 300
        while True:
            answer = self.read(until)
            assert answer is not None, "the browser does not answer to " + method
            if answer.get("id") == self.number:
                assert "error" not in answer, "%s: %s" % (method, answer["error"])
                return answer["result"]

    def read(self, until):
        """The next message; events are noted on the way. None when the time is over."""
        while b"\0" not in self.rest:
            if not select.select([self.into], [], [], max(0, until - time.monotonic()))[0]:
                return None
            piece = os.read(self.into, 1 << 20)
            assert piece, "the browser has ended: " + open(self.folder + "/stderr").read()[-2000:]
            self.rest += piece
        text, self.rest = self.rest.split(b"\0", 1)
        message = json.loads(text)
        what, p = message.get("method"), message.get("params", {})
        if what == "Runtime.exceptionThrown":
            d = p["exceptionDetails"]
            self.said.append("exception: " + d.get("exception", {}).get("description", d["text"]))
        elif what == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            self.said.append("%s: %s %s" % (p["entry"]["level"], p["entry"]["text"], p["entry"].get("url", "")))
        elif what == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            self.said.append("console: %s" % [a.get("value", a.get("description")) for a in p["args"]])
        elif what == "Network.requestWillBeSent":
            self.events.append(p["request"]["url"])
        return message

    def run(self, script):
        """An expression's value; promises are waited for."""
        got = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in got, "%s\n%s" % (script, got["exceptionDetails"])
        return got["result"].get("value")

    def wait(self, script, what=None, seconds=300):
        """Until an expression is true; returns its value."""
        until = time.monotonic() + seconds
        while True:
            try:
                value = self.run(script)
            except AssertionError as e:  # between two pages
                value = None
                if "Cannot find context" not in str(e) and "context was destroyed" not in str(e) and "exceptionDetails" not in str(e) and time.monotonic() > until:
                    raise
            if value not in (None, False, 0, ""):  # an element comes as {}
                return value
            if time.monotonic() > until:
                raise AssertionError("waited in vain for %s\n%s\n%s" % (what or script, self.said[-5:], self.run("document.body.innerText")[:1500]))
            self.read(time.monotonic() + 0.05)

    def work(self):
        """Seconds that the page's thread has worked, by the processor's clock."""
        return {m["name"]: m["value"] for m in self.call("Performance.getMetrics")["metrics"]}["TaskDuration"]

    def go(self, url):
        self.call("Page.navigate", url=url)
        self.wait("document.readyState === 'complete' && location.href !== 'about:blank'")

    def size(self, width, height, scale=1, phone=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=phone)

    def dark(self, on):
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if on else "light"}])

    def place(self, selector):
        """Where the element is: it must be in sight, nothing above it, and still there when the page has been drawn once more."""
        before, there = None, self.sight(selector)
        while there != before:
            self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")
            before, there = there, self.sight(selector)
        return there

    def sight(self, selector):
        return self.wait("""(() => { const e = [...document.querySelectorAll(%s)].find(e => e.checkVisibility()); if (!e) return null; e.scrollIntoView({block: 'nearest'});
            const r = e.getBoundingClientRect(), p = [r.x + r.width / 2, r.y + r.height / 2], top = document.elementFromPoint(...p);
            return r.width && (top === e || e.contains(top)) ? p : null; })()""" % json.dumps(selector), selector + " to be where it can be clicked")

    def click(self, selector):
        x, y = self.place(selector)
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def wheel(self, selector, by):
        x, y = self.place(selector)
        self.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=by)

    def type(self, text):
        self.call("Input.insertText", text=text)

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=KEYS[name])

    def picture(self, file, whole=False):
        got = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(file, "wb") as f:
            f.write(base64.b64decode(got["data"]))
