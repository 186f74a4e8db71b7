#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The measure of error on made-up pictures whose shift is known."""
import importlib.util
import math
import os
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, ROOT + "/tests/overlay")
import povray # noqa: E402
from povray import expect # noqa: E402

# By its path: this file has the same name.
spec = importlib.util.spec_from_file_location("measure", ROOT + "/tools/bhtrade/shift.py")
measure = importlib.util.module_from_spec(spec)
spec.loader.exec_module(measure)

N = 60 # pixels each way


def picture(see, fine=1, dx=0.0, dy=0.0):
	"""What see(x, y) says at the pixels' middles, shifted; x and y in whole pixels' widths."""
	return {(i, j): see((i + 0.5) / fine + dx, (j + 0.5) / fine + dy) for i in range(N * fine) for j in range(N * fine)}


def errors(see, other, **shifted):
	reference = measure.Reference(picture(see, measure.FINE))
	return measure.shifts(reference, picture(other, **shifted)), measure.Error(reference, picture(other, **shifted))


def sky(x, y):
	"""Strongly and unevenly magnified, turned, and on the sphere."""
	a, b = 0.01 * x + 0.00005 * x * x + 0.004 * y, 0.003 * y - 0.00002 * y * y
	return (("1", "sky", "-1"),), [(math.sin(a) * math.cos(b), math.sin(b), math.cos(a) * math.cos(b))]


def ball(x, y):
	"""A ball before that sky; places on it change without bound at its edge."""
	u, v = (x - 30.2) / 17, (y - 29.7) / 17
	if u * u + v * v >= 1:
		return sky(x, y)
	return (("1", "object", "0"),), [(u, v, math.sqrt(1 - u * u - v * v))]


def strip(x, y):
	return sky(x, y) if abs(x - 20.1) > 2.3 else ((("1", "object", "0"),), [(x, y, 0.0)])


def ring(x, y):
	"""All of a ring sees one point, as an Einstein ring does: along it nothing changes."""
	r = math.hypot(x - 29.63, y - 30.21)
	return (("1", "sky", "-1"),), [((x - 29.63) / r * (r - 20) * 0.003, (y - 30.21) / r * (r - 20) * 0.003, 1.0)]


# The same picture is not off at all; a shifted one by its shift.
_, same = errors(ball, ball)
expect((same.median, same.most, same.other, same.lost) == (0, 0, 0, 0), "the same picture is off by", vars(same))
for dx, dy in ((0.3, -0.2), (-0.02, 0.001), (0.0, 0.45)):
	far = math.hypot(dx, dy)
	found, error = errors(sky, sky, dx=dx, dy=dy)
	inner = sorted(e for (i, j), (e, _) in found.items())
	expect(abs(error.median - far) < 0.01 * far, "sky: shift", far, "median", error.median)
	expect(0.98 * far < inner[0] and inner[-1] < 1.02 * far, "sky: shift", far, "from", inner[0], "to", inner[-1])

	# On the way from one thing to another too: only the ball's very edge is less certain, to a third of a pixel.
	found, error = errors(ball, ball, dx=dx, dy=dy)
	expect(error.lost == 0, "ball: lost", error.lost)
	expect(error.other > 0 or far < 0.1, "ball: nobody met another thing at a shift of", far)
	expect(error.other < 2.2 * 2 * 17 * 2 * far / N**2, "ball: as many met another thing as the edge swept", error.other)
	expect(abs(error.median - far) < 0.01 * far, "ball: shift", far, "median", error.median)
	expect(0.9 * far < error.most < far + 0.34, "ball: shift", far, "most", error.most)
	swapped = sorted(e for e, met in found.values() if not met)
	expect(not swapped or swapped[-1] < far + 0.34, "ball: edge pixels off by", swapped[-3:])

# Four columns of pixels have their middles on the strip. Where it is gone, the two in its midst see what is seen nowhere within
# 1.5 pixels; where it should not be, all four do.
for see, other, columns in ((strip, sky, 2), (sky, strip, 4)):
	found, error = errors(see, other)
	lost = sum(math.isinf(e) for e, _ in found.values())
	expect(sum(not met for _, met in found.values()) == 4 * N, "a strip of four columns: other", error.other)
	expect(lost == columns * N and math.isclose(error.lost, columns / N), "lost of it, columns:", lost / N)

# A ring: outward shifts are found, and nothing is invented along it.
found, error = errors(ring, lambda x, y: ring(29.63 + (x - 29.63) * 1.01, 30.21 + (y - 30.21) * 1.01))
for (i, j), (e, _) in found.items():
	r = math.hypot(i + 0.5 - 29.63, j + 0.5 - 30.21)
	if r > 5:
		expect(abs(e - 0.01 * r) < 0.03 * 0.01 * r + 1e-3, "ring at", r, "off by", e)
sys.exit(povray.failures > 0)
