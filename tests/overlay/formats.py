#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""What povray writes to picture files, read back: formats.py stock|hole|float POVRAY

stock: a scene without a hole, in each format and with what may be asked of it, gives what Debian's own povray gives.
hole:  a scene with one gives the same picture in each format, within what the format can tell apart.
float: 32-bit OpenEXR keeps what half does not, and is otherwise as the half file.
"""
import math
import os
import struct
import sys

import povray
from povray import STOCK, expect, runs

WIDTH, HEIGHT = 61, 47 # no multiple of anything: rows are padded, the last block is short
SIZE = f" -D +WT1 +W{WIDTH} +H{HEIGHT}"


# Brighter than white, darker than a 16-bit step, see-through, and a sky that +UA leaves out.
PLAIN = """
camera { location <0, 1, -5> look_at 0 }
light_source { <3, 5, -5>, 3 }
sphere { 0, 1 pigment { rgbt <1, 0.5, 0.2, 0.4> } }
torus { 1.5, 0.3 pigment { gradient x color_map { [0 rgb <1, 0, 0>] [1 rgb <0, 0.3, 4>] } } }
plane { y, -1 pigment { checker rgb 0.3 rgb 1e-6 } finish { ambient 0.5 } clipped_by { sphere { 0, 4 } } }
"""
WORDS = """
+FN -A|+FN16 -A|+FN12 -A|+FN5 -A|+FE -A|+FE16 -A|+FP -A|+FP16 -A|+FB -A|+FT -A|+FC -A|+FJ -A|+FH -A
+FN +UA +A|+FN16 +UA +A|+FE +UA +A|+FT +UA +A|+FC +UA +A|+FB +UA +A|+FJ +UA +A|+FH +UA +A|+FP +UA +A
+FNg -A|+FPg -A|+FN16 Grayscale_Output=on -A|+FP16 Grayscale_Output=on -A|+FNg +UA +A
+FN Dither=on -A|+FN5 Dither=on Dither_Method=B4 -A|+FP Dither=on Dither_Method=D2 -A|+FT Dither=on Dither_Method=FS -A
+FB Dither=on Dither_Method=D1 -A|+FJ Dither=on -A|+FH Dither=on -A|+FE Dither=on -A
+FN File_Gamma=1 -A|+FN16 File_Gamma=2.5 +UA +A|+FP16 File_Gamma=sRGB -A|+FT File_Gamma=1 -A|+FB File_Gamma=1.8 -A
+FJ File_Gamma=1 Compression=100 -A|+FE File_Gamma=2.2 -A|+FH File_Gamma=2.2 -A
+FN32 -A|+FP32 -A|+FT32 -A|+FH32 -A|+FE8 -A|+FE24 -A|+FE31 -A|+FE33 -A|+FE64 -A|+FE288 -A|+FN1 -A
+FEg -A|+FE Grayscale_Output=on -A|+FE32 Grayscale_Output=on -A|+FJg -A|+FX -A|+FE3x -A
"""


def stock(program):
	words = WORDS.strip().replace("\n", "|").split("|")
	done = runs([(p, PLAIN, w + SIZE) for w in words for p in (STOCK, program)])
	identical = refused = 0
	for word, theirs, ours in zip(words, done[::2], done[1::2]):
		expect(theirs.code == ours.code, word, "exits with", ours.code, "not", theirs.code)
		if theirs.picture is None:
			refused += 1
			expect(ours.picture is None, word, "is refused by Debian's povray")
			expect(ours.last_word() == theirs.last_word(), word, "says", ours.last_word(), "not", theirs.last_word())
		elif ours.picture is None or not ours.picture.same(theirs.picture):
			expect(False, word, "differs from Debian's povray")
		else:
			identical += 1
	print(f"{identical} of {len(words)} identical, {refused} refused with the same words")
	expect(refused == 6, "6 are to be refused")


# Bright and dim, every colour, smooth: and a hole before it.
SKY = "sky_sphere { pigment { gradient y color_map { [0 rgb <0.02, 0.5, 1.6>] [0.5 rgb <0.9, 0.3, 1e-4>] [1 rgb <0.1, 1, 0.4>] } scale 2 translate -1 } }"
HOLE = """
camera { location <0, 3, -20> look_at <1, 0, 0> angle 50 }
blackhole { 0, 1 }
"""
BALL = "sphere { <5, 1, 3>, 2 pigment { rgb <1, 0.6, 0.1> } finish { ambient 0.7 diffuse 0 } }"


def most_off(picture, reference, clipped=False):
	"""The largest difference of a colour, and the largest over the pixel's brightest colour."""
	off = [0.0, 0.0]
	for p, r in zip(picture.rgba(), reference.rgba()):
		r = [min(c, 1.0) for c in r] if clipped else r
		d = max(abs(a - b) for a, b in zip(p[:3], r[:3]))
		off = [max(off[0], d), max(off[1], d / max(*r[:3], 1e-30))]
	return off


def black(picture):
	return {i for i, p in enumerate(picture.rgba()) if max(p[:3]) < 1e-30}


def hole(program):
	words = ["+FE32", "+FE", "+FH", "+FP16", "+FN16", "+FN", "+FP", "+FB", "+FT", "+FC", "+FJ Compression=100"]
	alpha = ["+FE32", "+FE", "+FN16", "+FN", "+FT", "+FC"]
	done = runs([(program, SKY + HOLE + BALL, w + " File_Gamma=1 -A" + SIZE) for w in words] +
		[(program, HOLE + BALL, w + " +UA File_Gamma=1 -A" + SIZE) for w in alpha] + [(program, HOLE + BALL, "+FE32 +UA +A0.01 +R3" + SIZE)])
	missing = [r for r in done if r.code or not r.picture]
	if missing:
		return expect(False, "no picture:", missing[0].last_word())
	got = [r.picture for r in done]
	exact = got[0]
	shadow = black(exact)
	print(f"the shadow has {len(shadow)} of {WIDTH * HEIGHT} pixels")
	expect(200 < len(shadow) < 1500, "a shadow of that size")
	# Half a step, and the rounding of the float that was rounded to it. RGBE gives eight bits to the brightest colour.
	for word, picture in zip(words[1:], got[1:]):
		absolute, relative = most_off(picture, exact, clipped=picture.most)
		if "J" in word: # shares colours between pixels, so only brightness can be compared
			light = lambda p: 0.299 * min(p[0], 1) + 0.587 * min(p[1], 1) + 0.114 * min(p[2], 1)
			d = [abs(light(a) - light(b)) for a, b in zip(picture.rgba(), exact.rgba())]
			print(f"{word[:3]:6} colours off by up to {absolute:.3f}, brightness by {max(d):.3f}, {sum(d) / len(d):.4f} on average")
			expect(sum(d) / len(d) < 2 / 255, word, "is another picture")
			continue
		limit, what = (0.5 / picture.most + 1.2e-7, absolute) if picture.most else ((2**-11 if "E" in word else 2**-8), relative)
		print(f"{word:6} off by up to {what:.2e}, limit {limit:.2e}")
		expect(what <= limit, word, "is further off than its rounding")
		expect(shadow <= black(picture), word, "loses black pixels")
	first = got[len(words)]
	opaque = [p for i, p in enumerate(first.rgba()) if i in shadow]
	clear = [p for p in first.rgba() if p[3] == 0]
	ball = [p for p in first.rgba() if p[3] == 1 and max(p[:3]) > 0]
	print(f"+UA: {len(opaque)} in the shadow, {len(clear)} clear, {len(ball)} of the ball")
	expect(all(p == (0, 0, 0, 1) for p in opaque), "a captured pixel is opaque black")
	expect(len(opaque) + len(clear) + len(ball) == WIDTH * HEIGHT and clear and ball, "everything else is the ball or clear sky")
	for word, picture in zip(alpha, got[len(words):]):
		d = max(abs(a[3] - b[3]) for a, b in zip(picture.rgba(), first.rgba()))
		expect(d == 0, word, "has another alpha, by", d)
		d = max(abs(a - min(b, 1)) for p, q in zip(picture.rgba(), first.rgba()) if q[3] for a, b in zip(p[:3], q[:3]))
		expect(d <= (0.501 / picture.most if picture.most else 2**-11), word, "+UA has another picture, by", d)
	rim = [p for i, p in enumerate(got[-1].rgba()) if 0 < p[3] < 1]
	dark = [p for p in rim if max(p[:3]) == 0]
	print(f"+UA +A: {len(rim)} pixels partly clear, {len(dark)} of them on the shadow's rim")
	expect(len(dark) > 40, "the shadow's rim is softened to clear sky")


# Flat fields of a known value: beyond half's largest, between its steps, among its smallest.
FIELDS = [70000.0, 3.14159274, 1.0009765, 0.1, 1e-6, 3e-8, 0.0]


def half(value):
	try:
		return struct.unpack("e", struct.pack("e", value))[0]
	except OverflowError:
		return math.inf


def floats(program):
	flat = "camera { orthographic location -z * 5 right x * {n} up y direction z } ".replace("{n}", str(len(FIELDS))) + " ".join(
		f"box {{ <{i - len(FIELDS) / 2}, -1, 0>, <{i + 1 - len(FIELDS) / 2}, 1, 1> pigment {{ rgb <{v}, {v / 2}, {v / 3}> }} finish {{ ambient 1 diffuse 0 }} }}"
		for i, v in enumerate(FIELDS))
	scenes = [flat, SKY + HOLE + BALL, PLAIN, "#version 3.7; global_settings { assumed_gamma 2.2 }" + PLAIN]
	done = runs([(program, s, w + SIZE) for s in scenes for w in ("+FE32 +UA", "+FE16 +UA", "+FE32", "Output_File_Type=E Bits_Per_Color=32")])
	for scene in range(len(scenes)):
		full, rounded, opaque, spelt = (r.picture for r in done[4 * scene:4 * scene + 4])
		expect((full.names, full.notes["kinds"]) == ("ABGR", "ffff"), "FLOAT channels A, B, G, R")
		expect((opaque.names, opaque.notes["kinds"]) == ("BGR", "fff"), "FLOAT channels B, G, R")
		expect((rounded.names, rounded.notes["kinds"]) == ("ABGR", "eeee"), "HALF channels A, B, G, R")
		expect(opaque.same(spelt), "+FE32 is Output_File_Type=E Bits_Per_Color=32")
		expect([p[1:] for p in full.pixels] == opaque.pixels, "without alpha: the same premultiplied colours")
		apart = [k for k in full.notes if full.notes[k] != rounded.notes.get(k)]
		expect(sorted(apart) == ["channels", "kinds"], "the attributes are the half file's, but", apart)
		expect(all(tuple(map(half, f)) == h for f, h in zip(full.pixels, rounded.pixels)), "rounded to half they are the half file's values")
		kept = sum(f != h for f, h in zip(full.pixels, rounded.pixels))
		expect(kept > WIDTH * HEIGHT / 3, "more than half keeps")
		print(f"{kept} of {len(full.pixels)} pixels are rounded in half")
	worst, lost = 0.0, 0.0
	for p, h, x in zip(done[0].picture.rgba(), done[1].picture.rgba(), range(WIDTH)):
		value = FIELDS[int((x + 0.5) * len(FIELDS) / WIDTH)]
		for c, d in zip(p[:3], (1, 2, 3)):
			worst = max(worst, abs(c - value / d) / max(value / d, 1e-30))
		lost = max([lost] + [abs(c * d - value) / max(value, 1e-30) for c, d in zip(h[:3], (1, 2, 3))])
	print(f"fields {FIELDS}: off by up to {worst:.1e} of their value in 32 bits, {lost:.1e} in half")
	expect(worst < 1e-6 and lost > 2**-11, "float's precision where half has less")


if len(sys.argv) != 3 or sys.argv[1] not in ("stock", "hole", "float"):
	sys.exit(__doc__)
if sys.argv[1] == "stock":
	povray.fetch_stock()
{"stock": stock, "hole": hole, "float": floats}[sys.argv[1]](os.path.realpath(sys.argv[2]))
sys.exit(povray.failures > 0)
