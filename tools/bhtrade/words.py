# SPDX-License-Identifier: AGPL-3.0-or-later
"""What the user said: our options, and povray's words."""
import os
import re

import runs


class Usage(Exception):
	"""Words that make no sense, in a line."""


class Asked:
	"""scene: a .pov or .ini; words: for povray. goal: "pixels" or "seconds", and how many."""

	def __init__(self, argv):
		self.scene, self.words, self.json, self.every_row = None, [], False, False
		self.goal, self.limit = "pixels", 0.5
		given = None
		rest = iter(argv)
		for word in rest:
			name, equals, value = word.partition("=")
			if name in ("--pixels", "--seconds"):
				if given not in (None, name):
					raise Usage("--pixels or --seconds, not both")
				given = name
				value = value if equals else next(rest, "")
				try:
					self.goal, self.limit = name[2:], float(value)
				except ValueError:
					self.limit = -1.0
				if not 0 < self.limit < 1e9:
					raise Usage(f"{name} needs a number above 0" + (f", not {value}" if value else ""))
			elif word == "--json":
				self.json = True
			elif word == "--all":
				self.every_row = True
			elif word.startswith("--"):
				raise Usage(f"there is no option {word}; bhtrade --help lists them")
			elif self.scene is None and word.lower().endswith((".pov", ".ini")):
				self.scene = word
			else:
				self.words.append(word)
		if self.scene is None:
			raise Usage("no scene: bhtrade scene.pov [words for povray] [--pixels X | --seconds S]")
		if not os.path.isfile(self.scene):
			raise Usage(f"there is no scene '{self.scene}'")
		for word in self.words:
			if re.match(r"(?i)[+-]([se][rc])\d|(start|end)_(row|column)=", word):
				raise Usage(f"{word}: the whole picture is looked at; leave it out")

	def for_povray(self):
		"""The scene and its words as povray wants them: it splits words at spaces that are not within quotes of its own."""
		said = [f'"{self.scene}"' if self.scene.lower().endswith(".ini") else f'+I"{self.scene}"', f'+L"{os.path.dirname(self.scene) or "."}"']
		for word in self.words:
			if '"' not in word and " " in word:
				if re.match(r"\w+=", word):
					word = re.sub(r"=(.*)", r'="\1"', word, flags=re.S)
				elif re.match(r"[+-][A-Za-z]", word):
					word = f'{word[:2]}"{word[2:]}"'
			said.append(word)
		return said


def frame(asked):
	"""The words that pick one frame of a film, the one half-way, and how many it has; no words and 1 for a picture."""
	lines = list(asked.words)
	for file in [asked.scene, *asked.words]:
		if file.lower().endswith(".ini") and os.path.isfile(file):
			with open(file, errors="replace") as text:
				lines = [line.strip() for line in text] + lines
	found = {"initial_frame": 1, "final_frame": 1}
	switches = {"kfi": "initial_frame", "kff": "final_frame", "sf": "subset_start_frame", "ef": "subset_end_frame"}
	for line in lines:
		m = re.match(r"(?i)(initial_frame|final_frame|subset_start_frame|subset_end_frame)\s*=\s*(-?\d+)\s*(?:;.*)?$|[+](kfi|kff|sf|ef)(-?\d+)$", line)
		if m:
			found[(m[1] or switches[m[3].lower()]).lower()] = int(m[2] or m[4])
	first, last = found.get("subset_start_frame", found["initial_frame"]), found.get("subset_end_frame", found["final_frame"])
	if found["final_frame"] <= found["initial_frame"]:
		return [], 1
	if last < first:
		raise runs.Failed(f"frames {first} to {last}: there are none")
	middle = (first + last) // 2
	return [f"Subset_Start_Frame={middle}", f"Subset_End_Frame={middle}"], last - first + 1
