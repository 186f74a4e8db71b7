# SPDX-License-Identifier: AGPL-3.0-or-later
"""What cannot be: one clear line that names it, a code that is not zero, and nothing is lost or left behind. (resume.py, tls.py and whole.py have more of it.)"""
import fcntl
import os
import re
import subprocess
import time

from authority import authority, openssl
from farm import BIN, ENV, PATIENCE, WORK, Server, bhfarm, scene

folder = WORK + "/scene"
ini = scene(folder, frames=5)


def refused(text, *words, **more):
    """One line with the text in it."""
    done = subprocess.run([BIN + "/" + words[0], *words[1:]], env=dict(ENV, **more), cwd=folder, capture_output=True, text=True, errors="replace", timeout=PATIENCE)
    lines = done.stderr.strip().split("\n")
    assert done.returncode == 1 and len(lines) == 1 and re.search(text, lines[0]) and not done.stdout, (words, done.returncode, done.stdout, done.stderr)


def write(name, data, mode=0o600):
    with open(WORK + "/" + name, "wb") as f:
        f.write(data)
    os.chmod(WORK + "/" + name, mode)
    return WORK + "/" + name


# The server.
serve = ("bhfarm-server", "--listen", "127.0.0.1:0", "--spool", WORK + "/spool")
server = Server()
refused("no option --bogus", *serve, "--bogus")
refused("what is 'stray'", *serve, "stray")
refused("--lease is '0'", *serve, "--lease", "0")
for address, text in (("nonsense", "the port in --listen ADDR:PORT is ''"), ("127.0.0.1:99999", "the port in --listen ADDR:PORT is '99999'"), ("127.0.0.1:x", "is 'x'"),
                      ("no.such.host.invalid:7700", "give a --token-file"), ("0.0.0.0:0", "give a --token-file")):
    refused(text, "bhfarm-server", "--listen", address, "--spool", WORK + "/spool")
refused("cannot listen on %s:%d: Address already in use" % (server.host, server.port), "bhfarm-server", "--listen", "%s:%d" % (server.host, server.port), "--spool", WORK + "/spool")
refused("another bhfarm-server has the spool " + server.spool, *serve[:3], "--spool", server.spool)
refused("cannot make the spool /proc/nosuch", *serve[:3], "--spool", "/proc/nosuch")
refused("cannot read /nosuch", *serve, "--token-file", "/nosuch")
refused("cannot read " + WORK, *serve, "--token-file", WORK)
refused("has no token", *serve, "--token-file", write("empty", b"# none\n"))
refused("go together", *serve, "--tls-cert", "x")
os.makedirs(WORK + "/garbage")
write("garbage/ledger.sqlite", b"this is no ledger" * 100)
refused("the ledger .*garbage/ledger.sqlite: file is not a database", *serve[:3], "--spool", WORK + "/garbage")
assert open(WORK + "/garbage/ledger.sqlite").read().startswith("this is no ledger")
# A token that others can read is taken, with a word about it.
open_token = write("open", b"0123456789abcdef\n", 0o644)
told = Server("--token-file", open_token)
assert "everybody here can read " + open_token in open(told.log).read()
done = bhfarm("status", "--token-file", open_token, server=told)
assert "everybody here can read " + open_token in done.stderr
refused("a token is needed", "bhfarm", "status", "--server", told.url)
refused("a token is needed", "bhfarm", "status", "--server", told.url, "--token-file", write("other", b"0123456789abcdee\n"))
refused("is empty", "bhfarm", "status", "--server", told.url, "--token-file", write("nothing", b"\n"))
refused("cannot read /nosuch", "bhfarm", "status", "--server", told.url, "--token-file", "/nosuch")

# Addresses and authorities: neither client nor worker tries on for what trying does not mend.
for program in (["bhfarm", "status"], ["bhfarm-worker"]):
    refused("it must be http://", *program, "--server", "ftp://x")
    refused("no answer from http://a b", *program, "--server", "http://a b")
    refused("cannot read /nosuch", *program, "--server", server.url, "--ca", "/nosuch")
refused("no answer from http://127.0.0.1:1", "bhfarm", "status", "--server", "127.0.0.1:1")
refused("there is no /nosuch", "bhfarm", "status", "--server", server.url + "/nosuch")
openssl("req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", "key.pem", "-out", "good.pem", "-days", "2", "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1")
openssl("req", "-new", "-key", "key.pem", "-out", "old.csr", "-subj", "/CN=127.0.0.1")
write("names", b"subjectAltName=IP:127.0.0.1\n")
openssl("x509", "-req", "-in", "old.csr", "-signkey", "key.pem", "-out", "old.pem", "-days", "-1", "-extfile", "names")
authority("other")
refused("cannot use the key", *serve, "--tls-cert", WORK + "/good.pem", "--tls-key", WORK + "/other.key")
expired = Server("--tls-cert", WORK + "/old.pem", "--tls-key", WORK + "/key.pem")
secure = Server("--tls-cert", WORK + "/good.pem", "--tls-key", WORK + "/key.pem")
for program in (["bhfarm", "status"], ["bhfarm-worker"]):
    refused("expired", *program, "--server", expired.url, "--ca", WORK + "/old.pem")
    refused("certificate", *program, "--server", secure.url, "--ca", WORK + "/other.pem")
    refused("certificate|CA", *program, "--server", secure.url, "--ca", write("noca", b"no certificate\n"))
bhfarm("status", "--server", secure.url, "--ca", WORK + "/good.pem")

# Workers.
refused("--slots is '0'", "bhfarm-worker", "--server", server.url, "--slots", "0")
refused("there is no povray at /nosuch", "bhfarm-worker", "--server", server.url, "--povray", "/nosuch")
refused("named no version", "bhfarm-worker", "--server", server.url, "--povray", "/bin/true", "--no-sandbox")
refused("cannot make /proc/x", "bhfarm-worker", "--server", server.url, "--cache", "/proc/x")

# Commands.
for words, text in ((["status", "x"], "the job's number is 'x'"), (["status", "99"], "there is no job 99"), (["watch"], "which job"), (["fetch", "99"], "there is no job 99"),
                    (["drain", "nobody"], "there is no worker nobody"), (["workers", "x"], "what is 'x'"), (["retry", "1", "2"], "which job"),
                    (["submit", "film.ini", "--frames", "9"], "the first of --frames is '9'"), (["submit", "film.ini", "--frames", "3-2"], "the last of --frames is '2'"),
                    (["submit", "film.ini", "--size", "640"], "the height in --size is ''"), (["submit", "film.ini", "--size", "0x5"], "the width in --size is '0'"),
                    (["submit", "film.ini", "--priority", "101"], "--priority is '101'"), (["submit", "film.ini", "--format", "gif"], "--format is 'gif'"),
                    (["submit", "film.ini", "--video", "x.avi"], "must end in .mp4"), (["submit", "film.ini", "--assets", "nosuch*"], "matches no file"),
                    (["submit", "film.ini", "+W70000"], "Width is '70000'"), (["submit", "film.ini", "+W60000", "+H60000"], "60000x60000, 3600000000 pixels; a frame may have"), (["submit", "film.ini", "Nonsense=3"], "Nonsense=3"), (["submit", "."], "there is no scene"),
                    (["submit", "nosuch\n.pov"], "there is no scene nosuch .pov"), (["submit", "film.pov", "--frames", "1-2"], "the scene has no Final_Frame")):
    refused(text, "bhfarm", words[0], "--server", server.url, *words[1:])
assert server.ask("/v1/jobs")[1]["jobs"] == []

# What POV-Ray itself would not name: the file that cannot be opened.
with open(folder + "/nopicture.pov", "w") as f:
    f.write('camera { location -5*z look_at 0 } plane { y, -1 pigment { image_map { png "nosuch.png" } } }\n')
refused("nopicture.pov' line 1: .*'nosuch.png'", "bhfarm", "submit", "nopicture.pov", "--server", server.url)
os.rename(folder + "/nopicture.pov", folder + "/n\u00f6.pov")
refused("cannot open .*/n\u00f6.pov: give it a name of ASCII letters", "bhfarm", "submit", "n\u00f6.pov", "--server", server.url)
assert server.ask("/v1/jobs")[1]["jobs"] == []
# A folder may have any name; and what somebody killed left behind in it goes, but for what is younger or in use.
strange = WORK + "/Ordner \u00fc"
scene(strange, frames=5)
os.makedirs(WORK + "/temporary")
scratch = {name: WORK + "/temporary/bhfarm-" + name for name in ("killed", "recent", "locked")}
for name, path in scratch.items():
    os.makedirs(path + "/out")
    hours = 0.5 if name == "recent" else 2
    os.utime(path, (time.time() - 3600 * hours,) * 2)
in_use = os.open(scratch["locked"], os.O_RDONLY)
fcntl.flock(in_use, fcntl.LOCK_EX)
done = subprocess.run([BIN + "/bhfarm", "submit", "film.ini", "--video", "none", "--server", server.url], env=dict(ENV, TMPDIR=WORK + "/temporary"), cwd=strange,
                      capture_output=True, text=True)
assert done.returncode == 0, done
assert sorted(os.listdir(WORK + "/temporary")) == ["bhfarm-locked", "bhfarm-recent"], os.listdir(WORK + "/temporary")
os.close(in_use)
names = [f["name"] for f in server.ask("/v1/bundles/" + server.job(int(done.stdout))["spec"]["bundle"])[1]["files"]]
assert {"film.pov", "parts/sky.inc", "colors.inc"} <= set(names), names
bhfarm("remove", done.stdout.strip(), server=server)

# A frame that nobody looked at before fails in words that are no UTF-8: the submitter reads them all the same. The worker goes on.
with open(folder + "/parts/sky.inc", "ab") as f:
    f.write(b'#if (clock > 0.2 & clock < 0.3) #error "caf\xe9 \xff \x1b[2J" #end\n')
worker = server.worker()
number = int(bhfarm("submit", ini, "--video", "none", server=server).stdout)
done = bhfarm("watch", str(number), server=server, good=False)
assert done.returncode == 1 and "frame 2" in done.stderr and "caf" in done.stderr, done
log = bhfarm("log", str(number), server=server).stdout
assert "caf" in log.split("\n")[0] and "\x1b" not in log, log
# Nor one that lacks a file there: the job says what brings it along. Of a worker that rests after all that, the list says so.
with open(folder + "/parts/sky.inc", "w") as f:
    f.write('#if (clock > 0.2 & clock < 0.3) #include "then.inc" #end\n')
with open(folder + "/then.inc", "w") as f:
    f.write("\n")
number = int(bhfarm("submit", ini, "--video", "none", server=server).stdout)
done = bhfarm("watch", str(number), server=server, good=False)
assert done.returncode == 1 and "frame 2" in done.stderr and "then.inc" in done.stderr and "--assets sends" in done.stderr, done
assert bhfarm("fetch", str(number), "--to", WORK + "/none", "--json", server=server).returncode == 0
number = int(bhfarm("submit", ini, "--video", "none", "--assets", "then.inc", server=server).stdout)
bhfarm("watch", str(number), server=server)
# Nor does a worker's name steer the terminal.
other = Server()
assert other.ask("/v1/workers", {"id": "a-worker-of-mine", "name": "\x1b]0;x\x07one\ntwo", "slots": 1, "povray": "3.7", "probe": ""})[0] == 201
table = bhfarm("workers", server=other).stdout
assert "one two" in table and "\x1b" not in table and "\x07" not in table and table.count("\n") == 2, table
one = int(bhfarm("submit", ini, "--frames", "1", "--video", "none", server=server).stdout)
bhfarm("watch", str(one), server=server)

# A disk that is full where the pictures go: no half of one stays, and there is another try.
if os.geteuid() == 0:
    os.makedirs(WORK + "/small")
    script = "mount -t tmpfs -o size=8k none %s/small && exec %s/bhfarm fetch --server %s %d --to %s/small" % (WORK, BIN, server.url, one, WORK)
    done = subprocess.run(["unshare", "-m", "sh", "-c", script + "; "], env=ENV, capture_output=True, text=True)
    if "unshare" not in done.stderr and "mount" not in done.stderr:
        lines = done.stderr.strip().split("\n")
        assert done.returncode == 1 and len(lines) == 1 and "No space left" in lines[0] and WORK + "/small/film1.png" in lines[0], done
    # As after 'bhfarm render'.
    script = ("mount -t tmpfs -o size=8k none %s/small && cd %s/small && %s/bhfarm render ../Ordner*/film.ini --frames 1-2; echo code $?; ls; mount -o remount,size=1m %s/small && "
              "%s/bhfarm render ../Ordner*/film.ini --frames 1-2" % (WORK, WORK, BIN, WORK, BIN))
    done = subprocess.run(["unshare", "-m", "sh", "-c", script], env=ENV, capture_output=True, text=True)
    if "unshare" not in done.stderr and "mount" not in done.stderr:
        # Which frame is finished first is chance.
        assert done.returncode == 0 and re.match("bhfarm: cannot write %s/small/film[12].png: No space left on device" % re.escape(WORK), done.stderr), done
        assert done.stdout.split("\n")[:2] == ["code 1", WORK + "/small/film1.png"], done
else:
    os.makedirs(WORK + "/sealed", 0o500)
    refused("cannot write to the folder " + WORK + "/sealed: Permission denied", "bhfarm", "render", "film.ini", "+O" + WORK + "/sealed/")
bhfarm("fetch", str(one), "--to", WORK + "/out", server=server)
assert os.path.exists(WORK + "/out/film1.png")
print("each one line, nothing lost")
