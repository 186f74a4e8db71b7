#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""With Reproducible=on a picture put together from strips is the whole one, whatever the cuts, threads and order.

	pieces.py POVRAY FEATURE   one of features.py; prints what was compared

Every strip is a process of its own. The whole frame by one process with one thread is the reference. Without
Reproducible=on, the features that are known to differ must: else these scenes would show nothing.
"""
import random
import sys
from concurrent.futures import ThreadPoolExecutor

import povray
from features import CAMERA, FEATURES, HOLE
from povray import expect

WIDTH, HEIGHT = 64, 56
# Blocks of 16 rows: cuts on their borders, beside them, and strips of one row.
CUTS = {"3": (0, 19, 37, 56), "7": (0, 8, 16, 24, 32, 40, 48, 56), "uneven": (0, 1, 17, 21, 55, 56)}


def part(first, last):
	"""The options for rows first (from 0) up to last. +ER1 is all of the picture to POV-Ray: it takes 1 for 100 %."""
	return f"+SR{first + 1} +ER{last if last > 1 else 1.5}"


def words(options, threads, first=0, last=HEIGHT, on=True):
	rows = "" if (first, last) == (0, HEIGHT) else part(first, last)
	return f"+FN16 -D +W{WIDTH} +H{HEIGHT} Render_Block_Size=16 {options} +WT{threads} {rows} Reproducible={'on' if on else 'off'}"


def strips(cut):
	return list(zip(cut, cut[1:]))


def rows(picture, first, last):
	return picture.pixels[first * picture.width:last * picture.width]


def render(program, jobs):
	"""Each (scene, words) in any order, two at a time."""
	order = list(range(len(jobs)))
	random.Random(len(jobs)).shuffle(order)
	with ThreadPoolExecutor(2) as pool:
		done = dict(zip(order, pool.map(lambda i: povray.Run(program, *jobs[i]), order)))
	for i, run in done.items():
		expect(run.code == 0 and run.picture, jobs[i][1], "fails:", run.last_word())
	return [done[i].picture for i in range(len(jobs))]


def different(program, scene, options, cuts, threads, on=True):
	"""Rows that are not those of the whole picture: of other thread counts, and for each cut of its strips."""
	pieces = [("whole", n, 0, HEIGHT) for n in threads] + [
		(cut, 1 + (i + len(cut)) % 2 if len(threads) > 1 else 1, a, b) for cut in cuts for i, (a, b) in enumerate(strips(CUTS[cut]))]
	jobs = [(scene, words(options, n, a, b, on)) for _, n, a, b in pieces]
	pictures = render(program, jobs)
	if None in pictures:
		return ["not rendered"]
	whole = pictures[0]
	expect(len(set(whole.pixels)) > 50, options, "shows next to nothing")
	return [f"{cut} +WT{n} row {y + 1}" for (cut, n, a, b), p in zip(pieces, pictures) for y in range(a, b) if rows(p, y, y + 1) != rows(whole, y, y + 1)]


def main():
	program, name = sys.argv[1:]
	camera, body, options, differs = FEATURES[name]
	scene = CAMERA % camera + body
	for holes, cuts, threads in ((HOLE, list(CUTS), (1, 2, 4)), ("", ["7"], (1, 2))):
		wrong = different(program, scene + holes, options, cuts, threads)
		expect(not wrong, name, "with a hole:" if holes else "without:", len(wrong), "rows differ:", *wrong[:5])
	if differs == "threads": # how they share the work is chance: seldom the same thread does it all
		stock = next(filter(None, (different(program, scene + HOLE, options, [], (1, 2, 4), on=False) for _ in range(20))), [])
	else:
		stock = different(program, scene + HOLE, options, ["3"], (1,), on=False)
	if name in ("plain", "am1", "am2", "blur"): # nothing is left to chance
		on, off = render(program, [(scene, words(options, 1, on=on)) for on in (True, False)])
		expect(on.same(off), name, "is another picture with Reproducible=on")
	print(f"{name}: without Reproducible=on, {len(stock)} rows differ")
	expect(stock or not differs, name, "is the same without Reproducible=on: this scene shows nothing")
	return povray.failures


if __name__ == "__main__":
	sys.exit(main() != 0)
