# SPDX-License-Identifier: AGPL-3.0-or-later
"""A scene that shows what it sees of the machine: behind the fence workers whose folders and programs lie elsewhere see the same for each strip, and agree; without it they do not."""
import os
import shutil
import sys

from farm import BIN, ENV, FENCED, WORK, Server, pixels, start, wait
from hand import JOB, bundle_of, sha

if not FENCED:
    print("bubblewrap does not work here")
    sys.exit(77)
PLACES = {name: WORK + "/" + folder for name, folder in (("near", "n"), ("far", "far/from/here/and/deep"))}
for place in PLACES.values():
    os.makedirs(place + "/tmp")
    shutil.copy(BIN + "/povray", place)
guesses = ["../strip.ini", "../ini", "../log", "../light", "../out", "../out/whole.png", "../out/light", "../render", "../../log", "out", "/strip.ini", "/ini", "/out", "/proc/self"]
guesses += [folder + "/x86_64-linux-gnu/libc.so.6" for folder in ("/lib", "/usr/lib", "/libraries")] + ["/usr/lib/os-release"]
guesses += ["../" * n + "lib64/ld-linux-x86-64.so.2" for n in range(1, 12)]
guesses += [place + "/" + name for place in PLACES.values() for name in ("povray", "cache", "cache/bundles", "tmp")]
# One bit a guess, a column of pixels each.
SCENE = "#version 3.7; global_settings { assumed_gamma 1 radiosity { count 5 } }\ncamera { orthographic location -z direction z right %d*x up 12*y }\n" % len(guesses)
SCENE += "".join('#if (file_exists("%s")) box { <%d, -9, 0>, <%d, 9, 1> pigment { rgb 1 } finish { emission 1 } } #end\n' % (g, i - len(guesses) / 2, i + 1 - len(guesses) / 2)
                 for i, g in enumerate(guesses))
files = {"scene.pov": SCENE.encode()}
bundle, name = bundle_of(files)


def rendered(who, *words, each=0):
    """The job as it ends, rendered by these, and its rows as one sees them."""
    server = Server("--check-every", str(each))
    assert server.ask("/v1/bundles", bundle)[1]["missing"] == [sha(files["scene.pov"])]
    server.ask("/v1/files/" + sha(files["scene.pov"]), raw=files["scene.pov"], method="PUT")
    status, answer = server.ask("/v1/jobs", dict(JOB, bundle=name, width=len(guesses), height=12, strip_rows=3, animation=False, first=0, last=0, digits=0))
    assert status == 201, answer
    for one in who:
        ENV["TMPDIR"] = PLACES[one] + "/tmp"
        start("bhfarm-worker", "--server", server.url, "--slots", "1", "--name", one, "--povray", PLACES[one] + "/povray", "--cache", PLACES[one] + "/cache",
              *words, log=WORK + "/" + one + ".log")
    wait(lambda: server.job(answer["job"])["stage"] != "running", "the job", None, server.log)
    said = open(server.log).read()
    assert server.job(answer["job"])["stage"] == "done" and "set aside" not in said, said
    _, rows = pixels(server.spool + "/jobs/%d/frames/x.png" % answer["job"])
    return [rows[i * 3 * len(guesses):(i + 1) * 3 * len(guesses)] for i in range(12)]


lines = rendered(PLACES, each=1) # each strip by both
assert len(set(lines)) == 1, "strips see different things"
seen = [g for i, g in enumerate(guesses) if lines[0][3 * i]]
assert seen == [g for g in guesses if g.endswith(".so.2")], seen # which stands for: it can see
free = [rendered([one], "--no-sandbox") for one in PLACES]
assert free[0] != free[1]
print("%d guesses: two workers and four strips see the same" % len(guesses))
