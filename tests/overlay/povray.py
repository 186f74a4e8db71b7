# SPDX-License-Identifier: AGPL-3.0-or-later
"""Runs povray for the tests in Python, each run in a folder of its own."""
import os
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor

import pictures

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
STOCK = ROOT + "/build/upstream/stock/usr/bin/povray"
HEAD = "#version 3.7; global_settings { assumed_gamma 1 }\n" # before every scene that has none of its own
failures = 0


def expect(fine, *what):
	global failures
	if not fine:
		failures += 1
		print("WRONG:", *what)


def fetch_stock():
	subprocess.run([ROOT + "/tools/stock"], check=True)


def start(povray, scene, words, folder, **more):
	"""povray at work in the folder; what it says goes to the file out there."""
	with open(folder + "/scene.pov", "w") as file:
		file.write(scene if scene.startswith("#version") else HEAD + scene)
	open(folder + "/none.ini", "w").close()
	# No settings of the user's; a home that a restricted povray.conf lets be read.
	env = {**os.environ, "HOME": folder, "POVINI": "none.ini", **more}
	with open(folder + "/out", "w") as out:
		return subprocess.Popen([povray, "+Iscene.pov", *words.split()], cwd=folder, env=env, stdin=subprocess.DEVNULL,
			stdout=out, stderr=subprocess.STDOUT)


PATIENCE = 600 # seconds: what hangs comes to that, and no machine that is merely slow or busy
NOT_STARTED = "Timed out waiting for worker thread startup" # what POV-Ray says where a machine is so busy that a thread did not begin in three seconds


def finish(process, seconds=PATIENCE):
	"""The exit code; 999 if it had to be killed."""
	try:
		return process.wait(seconds)
	except subprocess.TimeoutExpired:
		process.kill()
		process.wait()
		return 999


def patiently(render, said):
	"""What render() returns, given once more, up to 19 times, where povray had nothing to say but that the machine is too busy; said(that) is what it said."""
	for _ in range(20):
		done = render()
		if NOT_STARTED not in said(done):
			break
	return done


def run(povray, scene, words, folder):
	"""From start to end in the folder: the exit code."""
	return patiently(lambda: finish(start(povray, scene, words, folder)), lambda _: said(folder))


def said(folder):
	with open(folder + "/out", errors="replace") as file:
		return file.read()


def picture(folder):
	"""What was written, or None."""
	written = [f for f in os.listdir(folder) if f.rsplit(".", 1)[-1] in pictures.READERS]
	return pictures.read(folder + "/" + written[0]) if written else None


class Run:
	"""One rendering from start to end: its exit code, what it said, and the picture, if any."""

	def __init__(self, povray, scene, words):
		with tempfile.TemporaryDirectory() as folder:
			self.code = run(povray, scene, words, folder)
			self.text, self.picture = said(folder), picture(folder)

	def last_word(self):
		return self.text.strip().splitlines()[-1]


def runs(jobs):
	"""All of (povray, scene, words), eight at a time: povray sleeps for most of a small picture."""
	with ThreadPoolExecutor(8) as pool:
		return list(pool.map(lambda job: Run(*job), jobs))
