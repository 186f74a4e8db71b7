# SPDX-License-Identifier: AGPL-3.0-or-later
"""A lab with tokens and TLS of its own authority: let in with both, and with one line of refusal without either. A worker of another povray is turned away."""
import os
import subprocess

from authority import authority, certify
from farm import BIN, ENV, PATIENCE, WORK, Server, bhfarm, new_token, povray, same, scene

ini = scene(WORK + "/scene")
os.makedirs(WORK + "/reference")
povray(ini, WORK + "/scene", "+O" + WORK + "/reference/film")
for name in ("ca", "other"):
    authority(name)
certify("ca", "127.0.0.1")
for name in ("token", "wrong"):
    new_token(name)
server = Server("--token-file", WORK + "/token", "--tls-cert", WORK + "/server.pem", "--tls-key", WORK + "/server.key")
assert server.url.startswith("https://")
ENV["BHFARM_CA"] = WORK + "/ca.pem"
ENV["BHFARM_TOKEN_FILE"] = WORK + "/token"


def refused(words, text, **changes):
    done = subprocess.run([BIN + "/" + words[0], *words[1:]], env=dict(ENV, **changes), capture_output=True, text=True, timeout=PATIENCE)
    lines = done.stderr.strip().split("\n")
    assert done.returncode == 1 and len(lines) == 1 and text in lines[0], (words, done.returncode, done.stderr)


status = ["bhfarm", "status", "--server", server.url]
refused(status, "token", BHFARM_TOKEN_FILE=WORK + "/wrong")
refused(status, "certificate", BHFARM_CA=WORK + "/other.pem")
refused(status[:3] + [server.url.replace("https", "http")], "no answer from")
refused(["bhfarm-worker", "--server", server.url], "token", BHFARM_TOKEN_FILE=WORK + "/wrong")
refused(["bhfarm-server", "--listen", "127.0.0.1:0", "--spool", WORK + "/s", "--tls-cert", WORK + "/nosuch", "--tls-key", WORK + "/server.key"], "cannot use the certificate")
worker = server.worker(name="good")
number = int(bhfarm("submit", ini, server=server).stdout)
bhfarm("watch", str(number), server=server)
bhfarm("fetch", str(number), "--to", WORK + "/out", server=server)
for frame in ("film1.png", "film2.png"):
    same(WORK + "/out/" + frame, WORK + "/reference/" + frame)
# Another povray: one that says another version, and one that makes other pixels. Scripts need more than a fence lets them see.
for name, what in (("version", 'if [ "$1" = --version ]; then echo "POV-Ray 3.6"; exit; fi'), ("pixels", 'sed -i "s/Quality=.*//; s/^Width/Quality=1\\nWidth/" "$POVINI" 2>/dev/null')):
    with open(WORK + "/" + name, "w") as f:
        f.write('#!/bin/bash\n%s\nexec %s/povray "$@"\n' % (what, BIN))
    os.chmod(WORK + "/" + name, 0o755)
refused(["bhfarm-worker", "--server", server.url, "--no-sandbox", "--povray", WORK + "/version"], "its povray is 'POV-Ray 3.6'")
refused(["bhfarm-worker", "--server", server.url, "--no-sandbox", "--povray", WORK + "/pixels"], "makes other pixels")
refused(["bhfarm-worker", "--server", server.url, "--povray", WORK + "/version"], "cannot be fenced; give povray itself, or say --no-sandbox")
assert bhfarm("workers", server=server).stdout.count("good") == 1
bhfarm("drain", "good", server=server)
assert worker.wait(PATIENCE) == 0
print("tokens and TLS: in with both, refused without")
