# SPDX-License-Identifier: AGPL-3.0-or-later
"""Pictures of the page in all its states, to look at: page_pictures.py build/release/bin FOLDER. docs/page.png is one of them."""
import os
import shutil
import subprocess
import sys
import time

from browser import Browser
from farm import WORK, Server, bhfarm, new_token, scene, wait

to = os.path.abspath(sys.argv[2])
os.makedirs(to, exist_ok=True)
root = os.path.dirname(os.path.abspath(__file__)) + "/../.."
new_token()
open_one = Server("--check-every", "0")
browser = Browser(1280, 900)


def shot(name, dark=False, whole=False):
    browser.dark(dark)
    time.sleep(0.6)
    browser.picture("%s/%s.png" % (to, name), whole)


browser.go(open_one.url + "/")
browser.wait("!document.getElementById('nothing').hidden")
shot("empty")
shot("empty-dark", True)
shutil.copytree(root + "/scenes", WORK + "/scenes")
first = int(bhfarm("submit", WORK + "/scenes/orbit.ini", "+W320", "+H180", "--frames", "1-4", "--strips", "3", "--video", "none", server=open_one).stdout)
workers = [open_one.worker(name=n) for n in ("ada", "grace")]
bhfarm("watch", str(first), server=open_one)
bad = scene(WORK + "/bad", frames=10, extra='#if (clock > 0.3 & clock < 0.4) #error "no light in frame 4" #end\n')
bhfarm("submit", bad, "--strips", "2", server=open_one)
number = int(bhfarm("submit", WORK + "/scenes/fall.ini", "+W480", "+H270", "--strips", "8", "--priority", "5", server=open_one).stdout)
wait(lambda: open_one.job(number)["frames_done"] >= 10, "ten frames", seconds=600)
browser.run("location.hash = '#job-%d'" % number)
browser.wait("document.querySelectorAll('.tile img').length > 8")
shot("light")
subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", to + "/light.png", "-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none", to + "/page.png"], check=True)
shot("dark", True)
browser.click(".tile:nth-child(11)")
browser.wait("document.querySelector('#frame-picture img')")
shot("frame", True)
browser.key("Escape")
browser.size(360, 780, 2, True)
browser.run("scrollTo(0, document.getElementById('job').offsetTop - 8)")
shot("phone")
shot("phone-dark", True)
browser.run("scrollTo(0, document.body.scrollHeight)")
shot("phone-workers")
browser.size(1280, 900)
browser.run("scrollTo(0, 0)")
browser.click("#cancel")
shot("sure")
browser.key("Escape")
bhfarm("cancel", str(number), server=open_one)
browser.run("location.hash = '#job-%d'" % (number - 1))
browser.wait("document.getElementById('stage').textContent === 'failed'", seconds=120)
browser.wait("document.querySelector('#failure-rows li')")
browser.run("document.querySelector('#failure-rows details').open = true")
shot("failed", whole=True)
shot("failed-dark", True)
browser.run("location.hash = '#job-%d'" % first)
time.sleep(1)
shot("done")
still = int(bhfarm("submit", WORK + "/scenes/disc.pov", "+W640", "+H360", "--strips", "12", server=open_one).stdout)
browser.run("location.hash = '#job-%d'" % still)
wait(lambda: open_one.job(still)["strips_done"] >= 5, "five strips", seconds=600)
shot("still")
browser.size(2200, 1200)
shot("wide")
browser.size(1280, 900)
closed = Server("--token-file", WORK + "/token")
browser.go(closed.url + "/")
shot("sign-in")
shot("sign-in-dark", True)
print(len(browser.said), browser.said[-5:])
