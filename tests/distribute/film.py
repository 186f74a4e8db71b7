# SPDX-License-Identifier: AGPL-3.0-or-later
"""A film through a server and three workers, one killed (-9) at work and the server too, has the pixels of one povray's whole frames."""
import os
import signal
import time

from farm import PATIENCE, WORK, Gate, Server, bhfarm, pixels, povray, same, scene, wait

ini = scene(WORK + "/scene")
os.makedirs(WORK + "/reference")
povray(ini, WORK + "/scene", "+O" + WORK + "/reference/film")

server = Server("--lease", "2")
never, gate = Gate(), Gate()
first = server.worker(*never.words, name="first")
number = int(bhfarm("submit", ini, "--strips", "5", server=server, cwd=WORK + "/scene").stdout)
wait(lambda: server.job(number)["strips_out"], "a strip to go out")
first.kill()
third = server.worker(*gate.words, name="third")
wait(lambda: any(w["name"] == "third" and w["busy"] for w in server.ask("/v1/workers")[1]["workers"]), "the third to be at work")
second = server.worker(name="second")
wait(lambda: server.job(number)["strips_done"] >= 3, "three strips")
server.process.kill()
server.process.wait()
time.sleep(0.5)
server.again()
gate.open()
done = bhfarm("watch", str(number), server=server)
listed = bhfarm("fetch", str(number), "--to", WORK + "/out", server=server).stdout.split()
assert [os.path.basename(f) for f in listed] == ["film1.png", "film2.png", "film.mp4"], listed
for frame in ("film1.png", "film2.png"):
    same(WORK + "/out/" + frame, WORK + "/reference/" + frame)
assert pixels(WORK + "/out/film1.png") != pixels(WORK + "/out/film2.png"), "the film stands still"
for worker in (second, third):
    worker.send_signal(signal.SIGTERM)
    assert worker.wait(PATIENCE) == 0
assert server.ask("/v1/workers")[1]["workers"] == [] or all(w["name"] == "first" for w in server.ask("/v1/workers")[1]["workers"])
server.process.send_signal(signal.SIGTERM)
assert server.process.wait(PATIENCE) == 0
assert "damaged" not in open(server.log).read()
print("2 frames, 10 strips, two kills: the same pixels")
