#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""What Reproducible=on reads and writes, and frames one after the other: files.py POVRAY

A radiosity cache that strips share, pixels that are dithered when the picture is whole, an animation in one process.
"""
import os
import sys
import tempfile

import pictures
import povray
from features import AREA, BALLS, CAMERA, FEATURES, FOG, HOLE, RADIOSITY
from pieces import CUTS, HEIGHT, WIDTH, part, rows, strips
from povray import expect

PROGRAM = sys.argv[1]
EMPTY = "camera { }" # pixels from a file need no scene


class Folder:
	"""A place where several renderings meet; each picture there is called `out`, and an animation's out1, out2."""

	def __init__(self, scene):
		self.temporary = tempfile.TemporaryDirectory()
		self.path, self.scene = self.temporary.name + "/", scene

	def run(self, words, scene=None, size=f"+W{WIDTH} +H{HEIGHT}"):
		for old in os.listdir(self.path):
			if old.startswith("out"):
				os.remove(self.path + old)
		return povray.run(PROGRAM, scene or self.scene, f"{size} -D Render_Block_Size=16 Reproducible=on +Oout {words}", self.path), povray.said(self.path)

	def picture(self, words, scene=None):
		code, said = self.run(words, scene)
		expect(code == 0, words, said[-300:])
		written = sorted(f for f in os.listdir(self.path) if f.startswith("out."))
		return pictures.read(self.path + written[0])

	def bytes(self, name):
		with open(self.path + name, "rb") as file:
			return file.read()

	def write(self, name, data):
		with open(self.path + name, "wb") as file:
			file.write(data)


def refused(folder, words, *said, **more):
	code, text = folder.run(words, **more)
	expect(code != 0, words, "is not refused")
	expect(any(all(s in line for s in said) for line in text.splitlines()), words, "does not say", said, "but", text[-300:])


def radiosity():
	camera, body, options, _ = FEATURES["radiosity"]
	folder = Folder(CAMERA % camera + body + HOLE)
	options += " +FN16 Radiosity_File_Name=cache.rca"
	whole = folder.picture(options)
	# One task before the strips, of one row or of all, with whatever threads: the same file.
	first = folder.picture(options + " +SR1 +ER2 +WT2 Radiosity_To_File=on")
	expect(rows(first, 0, 2) == rows(whole, 0, 2), "the task that writes the cache shows other pixels")
	cache = folder.bytes("cache.rca")
	folder.picture(options + " +WT1 Radiosity_To_File=on")
	expect(cache == folder.bytes("cache.rca"), "another thread count writes another cache")
	for i, (a, b) in enumerate(strips(CUTS["7"])):
		strip = folder.picture(f"{options} {part(a, b)} +WT{1 + i % 2} Radiosity_From_File=on")
		expect(rows(strip, a, b) == rows(whole, a, b), "rows", a + 1, "to", b, "differ with the cache from a file")
	expect(cache == folder.bytes("cache.rca"), "strips change the cache")
	code, said = folder.run(options + " Radiosity_From_File=on")
	expect("Radiosity samples reused" in said and "No radiosity" in said, "a pretrace although the cache is there")
	# What is read is what was written: another light in the file is another picture.
	folder.write("cache.rca", cache.replace(b"0x1.", b"0x1.8", 5000))
	expect(rows(folder.picture(options + " Radiosity_From_File=on"), 0, HEIGHT) != rows(whole, 0, HEIGHT), "the file is not read")
	folder.write("cache.rca", cache[:len(cache) // 2])
	refused(folder, options + " Radiosity_From_File=on", "cache.rca", "not whole")


def dither():
	camera, body, options, _ = FEATURES["plain"]
	scene = "#version 3.7; global_settings { assumed_gamma 2.2 }\n" + CAMERA % camera + body + HOLE
	folder = Folder(scene + "background { rgbt 1 }")
	record = b""
	for i, (a, b) in reversed(list(enumerate(strips(CUTS["uneven"])))):
		folder.picture(f"{options} +FN8 {part(a, b)} +WT{1 + i % 2} Pixels_To_File=strip.pixels")
		record += folder.bytes("strip.pixels")
	folder.write("all.pixels", record)
	for kind in ("+FN8 Dither=on", "+FN8 Dither=on Dither_Method=D1", "+FN8 Dither=on Dither_Method=B3", "+FN5 Dither=on +UA", "+FN16 +UA", "+FP8 Dither=on",
			"+FN8 Grayscale_Output=on Dither=on", "+FE32", "+FN8 File_Gamma=1.8 Dither=on"):
		whole = folder.picture(f"{options} {kind}")
		stitched = folder.picture(f"{kind} Pixels_From_File=all.pixels", EMPTY)
		if "File_Gamma" in kind: # part of what the strips were rendered with
			expect(not whole.same(stitched), "File_Gamma is the strips'")
		else:
			expect(whole.same(stitched), kind, "differs from strips")
	# Dithered before, strips do not fit together: this test can fail.
	whole = folder.picture(f"{options} +FN5 Dither=on")
	strip = folder.picture(f"{options} +FN5 Dither=on +SR20 +ER40")
	expect(rows(whole, 19, 40) != rows(strip, 19, 40), "dither carries nothing from row to row")

	size = f"{WIDTH}x{HEIGHT}"
	refused(folder, "Pixels_From_File=all.pixels", "all.pixels", size, "32x32", scene=EMPTY, size="+W32 +H32")
	refused(folder, "Pixels_From_File=none.pixels", "none.pixels", "cannot be opened", scene=EMPTY)
	folder.write("short.pixels", record[:-9])
	refused(folder, "Pixels_From_File=short.pixels", "short.pixels", "ends in row", scene=EMPTY)
	folder.write("strip.pixels", record[record.index(b"pixels", 6):])
	refused(folder, "Pixels_From_File=strip.pixels", "row 56 of 56 is missing", scene=EMPTY)
	folder.write("other.pixels", b"P6 64 56 255\n")
	refused(folder, "Pixels_From_File=other.pixels", "other.pixels", "no such file as", scene=EMPTY)
	refused(folder, "Pixels_To_File=/nowhere/strip.pixels", "/nowhere/strip.pixels", "cannot be opened")


def animation():
	"""Frame 2 after frame 1 is frame 2 alone. Everything at once."""
	scene = CAMERA % "" + "global_settings { photons { count 2000 media 10 jitter 0.5 } subsurface { samples 4, 4 } mm_per_unit 20 }\n" + RADIOSITY % "" + AREA % "" + BALLS + \
		FOG % "method 1 intervals 2 samples 1, 2" + "sphere { <3 + clock, 0, -2>, 0.7 pigment { rgbf 0.9 } interior { ior 1.4 } photons { target reflection on refraction on } finish { crand 0.1 } }\n" + \
		"sphere { <clock, -2, -3>, 0.7 pigment { rgb 0.9 } finish { subsurface { translucency 0.3 } } interior { ior 1.4 } }\n" + HOLE
	words = "+A0.3 +AM2 +R1 +FN16 +KFI1 +KFF3 +WT2"
	folder = Folder(scene)
	code, said = folder.run(words)
	expect(code == 0, said[-300:])
	together = [folder.bytes(f"out{i}.png") for i in (1, 2, 3)]
	for i in (3, 2):
		code, said = folder.run(f"{words} +SF{i} +EF{i}")
		expect(code == 0, said[-300:])
		alone = folder.path + f"out{i}.png"
		folder.write("together.png", together[i - 1])
		expect(pictures.read(alone).pixels == pictures.read(folder.path + "together.png").pixels, "frame", i, "depends on those before it")
	expect(together[0] != together[1], "nothing moves")


def moment():
	"""Strips are parsed at different moments: `now` is none of them, but in stock's way of rendering it goes on."""
	folder = Folder(CAMERA % "" + BALLS + '#error concat("now is ", str(now, 0, 6))')
	said = "now is 0.000000"
	for words in ("", "Reproducible=off"):
		code, text = folder.run(words)
		expect(code != 0 and "now is" in text and (said in " ".join(text.split())) == (words == ""), words, "says", text[-300:])


radiosity()
dither()
animation()
moment()
sys.exit(povray.failures != 0)
