# SPDX-License-Identifier: AGPL-3.0-or-later
"""The page, in a real browser: signing in, a job watched to its end, paused, cancelled, failed; strangers' text, a phone, a film of 10,000 frames, a server
that starts over."""
import functools
import json
import os
import signal

from browser import Browser
from farm import ENV, PATIENCE, WORK, Gate, Server, bhfarm, new_token, scene, wait

TOKEN = new_token()
ENV["BHFARM_TOKEN_FILE"] = WORK + "/token"
server = Server("--token-file", WORK + "/token", "--check-every", "0", "--lease", "3600") # a stranger is not missed, however long this takes
ask = functools.partial(server.ask, token=TOKEN)
browser = Browser()
STAGE = "document.getElementById('stage').textContent"
# Text on what is behind it, by WCAG 2.2's formula, for all that is in sight.
CONTRAST = """(() => {
    const probe = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    const parts = text => { probe.clearRect(0, 0, 1, 1); probe.fillStyle = text; probe.fillRect(0, 0, 1, 1); return [...probe.getImageData(0, 0, 1, 1).data]; };
    const light = rgb => { const [r, g, b] = rgb.map(c => { c /= 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; }); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
    let worst = [99, ''];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
        const e = walk.currentNode.parentElement;
        if (!walk.currentNode.data.trim() || !e.checkVisibility() || e.closest('.unseen') || e.disabled || e.matches('.number')) continue;
        let behind = e, ground;
        while ((ground = parts(getComputedStyle(behind).backgroundColor))[3] < 255 && behind.parentElement) behind = behind.parentElement;
        const [a, b] = [light(parts(getComputedStyle(e).color).slice(0, 3)), light(ground.slice(0, 3))].sort((x, y) => y - x);
        const ratio = (a + 0.05) / (b + 0.05);
        if (ratio < worst[0]) worst = [ratio, e.className + ' ' + walk.currentNode.data.trim()];
    }
    return worst; })()"""


def quiet(*expected):
    """That the console has nothing but what was to be expected."""
    rest = [line for line in browser.said if not any(e in line for e in expected)]
    assert not rest, rest[:5]
    browser.said.clear()


def readable():
    for dark in (False, True):
        browser.dark(dark)
        ratio, what = browser.run(CONTRAST)
        assert ratio >= 4.5, "%s: %.2f to 1 in %s" % (what, ratio, "the dark" if dark else "the light")
    browser.dark(False)


def fits():
    browser.size(360, 740, 2, True)
    wide = browser.run("[document.documentElement.scrollWidth, innerWidth]")
    assert wide[0] <= 360, wide
    browser.size(1280, 860)


# Nobody is let in without the token; the cookie is not the token, and no script sees it.
browser.go(server.url + "/")
for token, shown in (("wrong", "document.getElementById('word').textContent.includes('not a token')"), (TOKEN, "document.getElementById('nothing')?.checkVisibility()")):
    browser.run("document.getElementById('token').focus()")
    readable()
    fits()
    browser.type(token)
    browser.click("form button")
    browser.wait(shown)
cookie, = browser.call("Network.getCookies")["cookies"]
assert cookie["httpOnly"] and cookie["sameSite"] == "Strict" and TOKEN not in cookie["value"] and cookie["name"].endswith(str(server.port)), cookie
assert browser.run("document.cookie") == ""
quiet("401")
readable()
fits()

# A job from elsewhere is seen, and fills in strip by strip to its end, without a reload.
browser.run("window.mark = 1")
bhfarm("submit", scene(WORK + "/scene"), "--strips", "5", server=server)
browser.wait(STAGE + " === 'running'")
browser.wait("document.querySelectorAll('#frames .tile').length === 2")
gate = Gate()
worker = server.worker(*gate.words, name="ada")
browser.wait("document.getElementById('worker-rows').innerText.includes('frame 1, rows')", "the worker to be on a strip")
readable()
TILE = "[...document.querySelectorAll('#frames .tile')].find(t => t.ariaLabel === 'Frame %d: %d of 5 strips done')"
for frame in (1, 2):
    shown = set()
    for strips in range(5):
        browser.wait(TILE % (frame, strips))
        if strips: # another picture each time
            shown.add(browser.wait("(i => i?.naturalWidth && !%s.includes(i.src) && i.src)(%s?.querySelector('img'))" % (json.dumps(sorted(shown)), TILE % (frame, strips))))
        gate.let()
    if frame == 1:
        browser.wait("document.title.startsWith('50 %')")
browser.wait(STAGE + " === 'done'")
browser.wait("[...document.querySelectorAll('#frames .tile')].every(t => t.querySelector('img')?.naturalWidth && t.ariaLabel.includes('5 of 5'))")
assert browser.run("window.mark") == 1
assert browser.run("fetch(document.getElementById('film').href).then(r => r.blob()).then(b => b.size)") > 1000
browser.click("#frames .tile")
browser.wait("document.querySelector('#frame-picture img')?.naturalWidth === 100")
assert browser.run("fetch(document.getElementById('frame-file').href).then(r => r.headers.get('content-type'))") == "image/png"
browser.key("ArrowRight")
browser.wait("document.getElementById('frame-title').textContent.startsWith('Frame 2')")
browser.key("Escape")
browser.wait("!document.getElementById('frame').open")
fits()
quiet()

# Paused, resumed and cancelled by clicks.
number = int(bhfarm("submit", scene(WORK + "/long", frames=400), "--strips", "5", "--video", "none", server=server).stdout)
wait(lambda: ask("/v1/jobs/%d" % number)[1]["strips_out"] == 1, "the worker to begin", worker, WORK + "/ada.log")
browser.wait("document.getElementById('job-title').textContent === 'film' && %s === 'running' && document.querySelector('#frames .tile')" % STAGE)
browser.click("#pause")
browser.wait(STAGE + " === 'paused'")
gate.let()
wait(lambda: ask("/v1/jobs/%d" % number)[1]["strips_out"] == 0, "the worker to come to rest")
browser.wait("document.getElementById('slots-busy').textContent === '0 of 1'")
browser.click("#resume")
browser.wait(STAGE + " === 'running' && document.getElementById('slots-busy').textContent === '1 of 1'")
browser.click("#cancel")
browser.click("#sure button[value=no]")
assert ask("/v1/jobs/%d" % number)[1]["stage"] == "running"
browser.click("#cancel")
browser.wait("document.getElementById('sure').open")
readable()
browser.click("#sure-yes")
browser.wait(STAGE + " === 'cancelled'")
assert ask("/v1/jobs/%d" % number)[1]["stage"] == "cancelled"
quiet()

gate.open()

# A scene that fails: POV-Ray's own line, and its output.
bhfarm("submit", scene(WORK + "/bad", frames=4, height=40, extra='#if (clock > 0.3 & clock < 0.4) #error "no light in frame 2" #end\n'), "--video", "none", server=server)
browser.wait(STAGE + " === 'failed'")
assert "Parse Error: Parse halted by #error directive: no light in frame 2" in browser.run("document.getElementById('job-error').textContent")
browser.wait("document.querySelector('#failure-rows pre')?.textContent.includes('no light in frame 2')")
browser.wait("document.querySelectorAll('#failure-rows > li').length >= 3")
readable()
fits()
browser.click("#retry")
browser.wait(STAGE + " === 'running' || %s === 'failed'" % STAGE)
worker.send_signal(signal.SIGINT)
worker.wait(PATIENCE)
quiet()

# What strangers name their jobs and workers, and what they say, is text.
spec = ask("/v1/jobs/1")[1]["spec"]
bad = "<img src=x onerror=window.hit=1>" + "w" * 60
assert ask("/v1/workers", {"id": "a-stranger", "name": "<b onclick=window.hit=1>" + bad[:32], "slots": 1, "povray": "3.7", "probe": ""})[0] == 201
strange = ask("/v1/jobs", dict(spec, name=bad, whole_because=bad, client_key="strange", priority=100))[1]["job"]
lease = ask("/v1/workers/a-stranger/take", {"wait": 5})[1]["lease"]
assert ask("/v1/leases/%d/failure" % lease, {"line": bad, "log": bad})[1]["accepted"]
lease = ask("/v1/workers/a-stranger/take", {"wait": 5})[1]["lease"]
browser.run("location.hash = '#job-%d'" % strange)
browser.wait("document.getElementById('job-title').textContent === %s" % json.dumps(bad))
browser.wait("document.getElementById('failures').textContent.includes('window.hit') && document.getElementById('workers').textContent.includes('window.hit')")
browser.wait("document.querySelector('#frames .tile')?.ariaLabel === 'Frame 1: 0 of 5 strips done'")
browser.click("#frames .tile")
browser.wait("document.getElementById('frame').textContent.includes('window.hit')")
browser.key("Escape")
assert browser.run("window.hit === undefined && !document.querySelector('img[src=x], [onclick], [onerror]')")
fits()
quiet()

# Ten thousand frames of 34 strips: a few tiles, and not the work of counting to two hundred million (measured: to twenty). By the processor's clock, as the machine may be busy.
film = ask("/v1/jobs", dict(spec, client_key="large", name="large", first=1, last=10000, digits=5, width=1920, height=1080, strip_rows=32))[1]["job"]
yardstick = browser.work()
browser.run("(() => { let n = 0; for (let i = 0; i < 1e8; ++i) n = (n * 31 + i) | 0; return n; })()")
yardstick = browser.work() - yardstick
before = browser.work()
browser.run("location.hash = '#job-%d'" % film)
browser.wait("document.querySelector('#frames .tile')?.ariaLabel === 'Frame 1: 0 of 34 strips done'")
browser.wheel("#frames", 1e7)
browser.wait("[...document.querySelectorAll('#frames .tile')].some(t => t.ariaLabel.startsWith('Frame 10000:'))")
assert browser.run("document.querySelectorAll('#frames .tile').length") < 100
worked = browser.work() - before
assert worked < 2 * yardstick, (worked, yardstick)
ask("/v1/jobs/%d/cancel" % film, method="POST", raw=b"")
quiet()

# Signed out, the page is shut; and a server that started over asks for the token again.
browser.click("#sign-out")
browser.wait("document.getElementById('token')")
browser.run("document.getElementById('token').focus()")
browser.type(TOKEN)
browser.click("form button")
browser.wait("document.getElementById('link')?.dataset.state === 'live'")
server.process.kill()
server.process.wait()
browser.wait("document.getElementById('link')?.dataset.state === 'lost'")
server.again()
browser.wait("document.getElementById('token')", "the sign-in")
assert all(url.startswith((server.url, "data:", "about:")) for url in browser.events), [u for u in browser.events if not u.startswith(server.url)]
quiet("401", "ERR_CONNECTION_REFUSED", "ERR_INCOMPLETE_CHUNKED_ENCODING", "ERR_CONNECTION_RESET")

# Without tokens the stream comes back by itself.
ENV.pop("BHFARM_TOKEN_FILE")
open_one = Server("--check-every", "0")
browser.go(open_one.url + "/")
browser.wait("document.getElementById('link').dataset.state === 'live'")
browser.run("window.mark = 2")
open_one.process.kill()
open_one.process.wait()
browser.wait("document.getElementById('link').dataset.state === 'lost'")
open_one.again()
bhfarm("submit", WORK + "/scene/film.ini", server=open_one)
browser.wait("document.getElementById('link').dataset.state === 'live' && document.getElementById('job-title').textContent === 'film'")
assert browser.run("window.mark") == 2 and browser.run("document.getElementById('sign-out').checkVisibility()") is False
quiet("ERR_CONNECTION_REFUSED", "ERR_INCOMPLETE_CHUNKED_ENCODING", "ERR_CONNECTION_RESET")
folder, process = browser.folder, browser.process
browser.close()
assert process.returncode is not None and not os.path.exists(folder)
print("each strip seen; the large film took the page %.2f s, a count to a hundred million %.2f s" % (worked, yardstick))
