# SPDX-License-Identifier: AGPL-3.0-or-later
"""Runs bench/trade's smallest table and asks what must hold of it: that errors fall with tolerance and effect radius as theory has it,
and that Euler's method is worse in more time.

  sane.py TRADE
"""
import csv
import math
import subprocess
import sys

DIRECT = ("far", "middle", "near", "disc", "wall", "floor", "close")
bad = []


def ask(true, what):
	if not true:
		bad.append(what)


# The program itself compares its exact answers with quadrature, and fails if they differ by 1e-9.
text = subprocess.run([sys.argv[1], "--quick"], check=True, stdout=subprocess.PIPE, text=True).stdout
at = {}
for row in csv.DictReader(text.splitlines()):
	key = row["scene"], row["method"], float(row["tolerance_or_step"]), float(row["effect_radius"])
	at[key] = {k: float(v) for k, v in row.items() if k not in ("scene", "method")}
	ask(all(math.isfinite(v) for v in at[key].values()), "%s: not a number" % (key,))

# The frame of the effect sphere makes a picture larger by 1/sqrt(1 - 1/R) about the hole (docs/manual.md); a closed form's only
# error is that, most at the corners. Pixels are the middles of 40 x 40 squares, nearly.
for scene in DIRECT[:3]:
	for R in (100.0, 1000.0, 10000.0):
		most = math.hypot(960 - 20, 540 - 20) * (1 / math.sqrt(1 - 1 / R) - 1)
		ask(abs(at[scene, "sky", 0, R]["clear_max_px"] / most - 1) < 0.03, "%s: %g px at R = %g, expected about %g" %
			(scene, at[scene, "sky", 0, R]["clear_max_px"], R, most))

ANGLES = {"far": 12, "middle": 40, "near": 67}
for scene in DIRECT:
	for method in ("rk4", "dopri5", "exact"):
		tolerances = (1e-2, 1e-3, 5e-4, 1e-4)
		e = [at[scene, method, t, 10000]["p999_px"] for t in tolerances]
		if scene in ANGLES: # the manual's promise: off by the tolerance at most, and by what the effect radius costs
			pixel = math.tan(math.radians(ANGLES[scene] / 2)) / 960
			kept = all(x < t / pixel + at[scene, "sky", 0, 10000]["max_px"] for x, t in zip(e, tolerances))
			ask(kept, "%s, %s: errors %s are more than the tolerance" % (scene, method, e))
		else:
			ask(e[0] > e[1] > e[2] > e[3], "%s, %s: errors %s do not fall with the tolerance" % (scene, method, e))
		ask(at[scene, method, 5e-4, 10000]["wrong"] < 3e-3, "%s, %s: wrong things seen" % (scene, method))
	# Chords stray by their length squared: ten times the tolerance, ten times the error, where chords are what is wrong.
	if scene in DIRECT[3:]:
		ratio = at[scene, "exact", 1e-2, 10000]["p999_px"] / at[scene, "exact", 1e-3, 10000]["p999_px"]
		ask(5 < ratio < 20, "%s: a tenth of the tolerance gives %g of the error" % (scene, 1 / ratio))
	ours, theirs, coarse = (at[(scene,) + s + (10000,)] for s in (("rk4", 5e-4), ("euler-r", 0.01), ("euler-r", 0.1)))
	ask(theirs["us_per_ray"] > ours["us_per_ray"], "%s: Euler takes less time" % scene)
	ask(theirs["p999_px"] > 10 * ours["p999_px"], "%s: Euler is as good" % scene)
	# Of first order.
	ratio = coarse["median_px"] / theirs["median_px"]
	ask(5 < ratio < 20, "%s: a tenth of Euler's step gives %g of the error" % (scene, 1 / ratio))

sys.exit("\n".join(bad) if bad else 0)
