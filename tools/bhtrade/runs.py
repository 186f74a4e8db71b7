# SPDX-License-Identifier: AGPL-3.0-or-later
"""Runs povray on a part of the picture, and reads its statistics."""
import os
import re
import subprocess
import tempfile
import time

import ends

BLOCK = 8 # pixels across a block of the sample: small, so that a sample has something of every part of the picture


class Failed(Exception):
	"""What went wrong, in a line or two for the user."""


def number(value):
	"""Short, as one would write it in a scene."""
	text = f"{value:g}"
	return text.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


class Stopped(BaseException):
	"""A signal that would end us at once: povray, and what it writes, must go first."""


held, waits = False, None # whether a signal has to wait, and one that does


def stop(number, _):
	"""What a signal does. While povray is being started nobody could end it yet: then the signal waits."""
	global waits
	if not held:
		raise Stopped(number)
	waits = number


def said_by(command):
	"""Runs it to its end, or ends it with us: its exit code, and what it said."""
	global held
	held = True
	try:
		process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
	except BaseException:
		held = False
		raise
	try:
		held = False
		if waits is not None:
			raise Stopped(waits)
		out, errors = process.communicate()
	except BaseException:
		process.kill()
		process.wait()
		raise
	return process.returncode, out + errors


class Setting:
	"""Of the holes; None: as the scene has it. effect_radius in Schwarzschild radii."""

	def __init__(self, method=None, tolerance=None, effect_radius=None):
		self.method, self.tolerance, self.effect_radius = method, tolerance, effect_radius

	def words(self):
		"""For povray's command line."""
		keys = ("Blackhole_Method", self.method), ("Blackhole_Tolerance", self.tolerance), ("Blackhole_Effect_Radius", self.effect_radius)
		return [f"{key}={value if isinstance(value, str) else number(value)}" for key, value in keys if value is not None]


class Times:
	"""Seconds of one run, by the processors' clocks: other programs have no part in them. pixels: as povray counts them, with those
	that antialiasing adds at the blocks' edges, and those that radiosity looks at beforehand."""

	def __init__(self, text, wall):
		self.threads, self.start, self.parts = 1, wall, {}
		for name, seconds, threads, processor in re.findall(
			r"(\w+) Time:[^(\n]*\((\d+\.\d+) seconds\)\s+using (\d+) thread\(s\) with (\d+\.\d+) CPU", text):
			self.parts[name] = float(processor) / int(threads)
			self.start -= float(seconds) # what remains is for starting and stopping
			self.threads = max(self.threads, int(threads))
		if "Trace" not in self.parts:
			raise Failed("povray's statistics have no trace time; is this our povray?")
		self.pixels = float(re.search(r"Pixels:\s+(\d+)", text)[1])
		# Antialiasing looks at a block's neighbours above and to the left too; in a whole picture blocks are 32 pixels wide.
		smooth = re.search(r"Antialiasing\.+On +\(Method (\d)", text)
		self.share = (33 / 32) ** 2 if smooth else 1.0
		# Those neighbours are looked at once only: what method 1 adds to a pixel is not theirs. (Method 2 shares rays among pixels.)
		more = re.search(r"Samples:\s+(\d+)", text)
		self.added = float(more[1]) if smooth and smooth[1] == "1" and more else None
		m = re.search(r"Image Resolution (\d+) x (\d+)", text)
		self.width, self.height = int(m[1]), int(m[2])

	def before(self):
		"""Parsing, photons, radiosity's look at the whole: what does not grow with the picture."""
		return sum(seconds for name, seconds in self.parts.items() if name != "Trace")

	def whole(self, pretraced):
		"""The whole picture, less starting, on a machine that has nothing else to do. pretraced: pixels of radiosity's look."""
		looked_at = max(1, self.pixels - pretraced)
		times = self.width * self.height * self.share / looked_at
		if self.added is not None:
			own = looked_at / ((BLOCK + 1) / BLOCK) ** 2
			rays = self.width * self.height * (self.share + self.added / own)
			times = rays / (looked_at + self.added)
		return self.before() + self.parts["Trace"] * times


class Povray:
	"""povray with a scene's words; a folder of its own holds what it writes."""

	def __init__(self, binary, words):
		self.binary, self.words = binary, words
		self.start = float("inf") # seconds to start and stop, the least met
		self.folder = tempfile.TemporaryDirectory(prefix="bhtrade-")

	def run(self, words):
		# POV-Ray splits words at spaces that are not within quotes of its own, and has the last word count.
		command = [self.binary, *self.words, "Output_to_File=off", "Display=off", "Pause_when_Done=off", "Verbose=off", "Continue_Trace=off",
			"All_Console=on", "Preview_Start_Size=1", "Preview_End_Size=1", f"Render_Block_Size={BLOCK}", *words]
		for _ in range(20): # on a busy machine a thread may not begin in the three seconds that POV-Ray gives it
			start = time.monotonic()
			code, text = said_by(command)
			wall = time.monotonic() - start
			if code == 0 or "Timed out waiting for worker thread startup" not in text:
				break
		if code != 0:
			raise Failed(what_povray_said(text) or f"povray ended with exit code {code}")
		return text, wall

	def time(self, setting, every):
		"""Times of a run that renders one of so many blocks."""
		times = Times(*self.run([*setting.words(), f"Sample_Blocks={every}"]))
		self.start = min(self.start, max(0.0, times.start))
		return times

	def ends(self, setting, every, width, height, fine=1):
		"""The holes and the pixels' ends (ends.read) of such a run, of a picture that is so many times finer. Neither media nor
		antialiasing have a say in where rays end."""
		file = os.path.join(self.folder.name, "ends.csv")
		self.run([*setting.words(), f"Sample_Blocks={every}", f'Ray_Ends="{file}"', "Antialias=off", "Quality=8",
			f"Width={width * fine}", f"Height={height * fine}", f"Render_Block_Size={BLOCK * fine}"])
		try:
			return ends.read(file)
		finally:
			os.unlink(file)


def what_povray_said(text):
	"""Its errors, without the lines of the scene and the console's line breaks in words."""
	lines = [line.strip() for line in text.splitlines()]
	for i, line in enumerate(lines):
		if re.search(r"[Ee]rror|Cannot|Failed|failed", line) and "warning" not in line.lower():
			said = []
			for more in lines[i:]:
				if not more or more.startswith(("Render failed", "Fatal error in parser: Cannot parse", "====", "----")):
					break
				said.append(more)
			return " ".join(said)
	return ""
