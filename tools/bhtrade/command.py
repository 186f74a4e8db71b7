# SPDX-License-Identifier: AGPL-3.0-or-later
"""Usage: bhtrade scene.pov [+W1920 +H1080 and any other words for povray] [--pixels X | --seconds S] [--json] [--all]

Renders small parts of a scene with black holes at several settings of theirs (method, tolerance, effect_radius), and prints for
each the time expected for the full picture, how far off the picture is, in pixels, and the setting it recommends.

  --pixels X    the quickest setting that keeps 99.9 % of the pixels within X pixels; this is the default, with X = 0.5
  --seconds S   the most accurate setting that takes at most S seconds (of a film: all frames)
  --all         all settings tried; without it, those that no other beats in both time and accuracy
  --json        all of it as JSON

A pixel's error is the shift on the screen that explains what it shows: how far from the pixel's middle a reference (exact, a
very small tolerance, an effect radius of 10,000,000 Schwarzschild radii) sees what the pixel sees, by where its rays end, also after
reflections and refractions that carry at least 5 % of its light. "other" is the share of pixels that met another thing than the
reference met, "lost" of those that show what the reference shows nowhere within 1.5 pixels: they count as infinitely far off.
On steep ground what is seen changes too fast from pixel to pixel to tell: beside the edge of the shadow (within 0.1 % of the critical
impact parameter and somewhat more) and at limbs. Such pixels are taken to be as far off as those beside them.
What is blurred (focal blur, antialiasing, media) is judged by the ray through each pixel's middle.

Exit codes: 0 a setting is recommended; 1 povray could not render the scene, or there is no hole in it; 2 wrong words; 3 no
setting keeps the goal."""
import os
import signal
import sys

import runs
import table
import trade
import words


def progress(line):
	if sys.stderr.isatty():
		sys.stderr.write("\r\033[K" + (f"bhtrade: {line}" if line else ""))
		sys.stderr.flush()


def main(argv, povray, defaults):
	"""povray: the binary; defaults: words for it before the user's."""
	for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
		if signal.getsignal(number) != signal.SIG_IGN: # as nohup sets it
			signal.signal(number, runs.stop)
	try:
		code = answer(argv, povray, defaults)
		sys.stdout.flush()
		return code
	except BrokenPipeError:
		# Who read us has enough; what is left must not fail anew at the end.
		os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
		return 128 + signal.SIGPIPE
	except runs.Stopped as stopped:
		progress("")
		return 128 + stopped.args[0]


def answer(argv, povray, defaults):
	"""Does what is asked; returns the exit code."""
	if not argv or argv[0] in ("-h", "--help"):
		print(__doc__)
		return 0 if argv else 2
	try:
		asked = words.Asked(argv)
		chosen, frames = words.frame(asked)
		if not os.access(povray, os.X_OK):
			raise runs.Failed(f"there is no povray at {povray}: build it first")
		if not asked.scene.lower().endswith(".pov"):
			defaults = [word for word in defaults if word[:2] not in ("+W", "+H")]
		measured = trade.Trade(runs.Povray(povray, [*defaults, *asked.for_povray(), *chosen]), asked.goal, asked.limit, frames, progress)
		best = measured.look()
		progress("")
		if asked.json:
			print(table.as_json(measured, best, asked.scene))
		else:
			print(table.heading(measured, asked.scene, chosen), table.table(measured, best, asked.every_row), sep="\n\n")
		say = sys.stdout if best and not asked.json else sys.stderr
		print(("\n" if best else "bhtrade: ") + table.advice(measured, best), file=say)
		return 0 if best else 3
	except words.Usage as wrong:
		print(f"bhtrade: {wrong}", file=sys.stderr)
		return 2
	except runs.Failed as wrong:
		progress("")
		print(f"bhtrade: {wrong}", file=sys.stderr)
		return 1
