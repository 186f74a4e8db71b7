#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The preview window, looked at in a server of its own: preview.py POVRAY

It must do with a hole what Debian's own povray's does without: open and fill with +D, stay with +P until a key or a
click, show what the file says, and cancel when told to. Where Debian's povray heeds nothing, neither may ours.
"""
import ctypes
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time

import povray
from povray import STOCK, expect

WIDTH, HEIGHT = 160, 120
SCENE = """
camera { location <0, 3, -20> look_at <1, 0, 0> angle 50 }
light_source { <10, 20, -20>, 1 }
sky_sphere { pigment { granite scale 0.6 color_map { [0 rgb <0.1, 0.5, 0.9>] [1 rgb <0.9, 0.3, 0.1>] } } }
sphere { <5, 1, 3>, 2 pigment { rgb <1, 0.6, 0.1> } finish { reflection 0.3 } }
"""
# So slow that one can see it work: a sum of many sines at each point.
TERMS = " + ".join(f"sin({i} * x) * sin({i} * z) / {i}" for i in range(1, 40))
SLOW = SCENE + "isosurface { function { y + 3.5 + 0.1 * (" + TERMS + ") } contained_by { box { -9, <9, -3, 9> } } max_gradient 3 pigment { rgb 0.7 } }\n"
BLACKHOLE = "blackhole { 0, 1 tolerance 1e-3 }\n"


class Server:
	"""An X server without a screen; its picture is a file."""

	def __init__(self, folder):
		read, write = os.pipe()
		self.file = folder + "/Xvfb_screen0"
		self.process = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "320x240x24", "-fbdir", folder, "-nocursor",
			"-noreset", "-nolisten", "tcp"], pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
		os.close(write)
		with os.fdopen(read) as number:
			self.display = ":" + number.readline().strip()
		self.tool("mousemove", "20", "20")

	def tool(self, *words):
		env = {**os.environ, "DISPLAY": self.display}
		return subprocess.run(["xdotool", *words], env=env, stdout=subprocess.PIPE, check=True).stdout.decode()

	def shown(self):
		"""Its upper left corner, of a preview's size: there it is where no window manager moves it."""
		with open(self.file, "rb") as file:
			data = file.read()
		head = struct.unpack(">25I", data[:100])
		assert head[1] == 7 and head[11] == 32 and head[7] == 0, "an XWD file, 32 bits a pixel, least first"
		start, stride = head[0] + 12 * head[19], head[12]
		rows = [data[start + y * stride:start + y * stride + 4 * WIDTH] for y in range(HEIGHT)]
		return [(row[x + 2], row[x + 1], row[x]) for row in rows for x in range(0, 4 * WIDTH, 4)]

	def window(self):
		"""The window that is there, its place and size, and its title; None if there is none."""
		for number in self.tool("search", "--onlyvisible", "--maxdepth", "1", "--name", ".*").split():
			geometry = dict(line.split("=") for line in self.tool("getwindowgeometry", "--shell", number).split())
			if (geometry["WIDTH"], geometry["HEIGHT"]) != ("320", "240"): # the screen itself
				return int(number), *(int(geometry[k]) for k in ("X", "Y", "WIDTH", "HEIGHT")), self.tool("getwindowname", number).strip()
		return None

	def close_window(self):
		"""What a window manager sends when one clicks a window's cross."""

		class ClientMessage(ctypes.Structure):
			_fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("sent", ctypes.c_int), ("display", ctypes.c_void_p),
				("window", ctypes.c_ulong), ("kind", ctypes.c_ulong), ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("rest", ctypes.c_long * 24)]

		x = ctypes.CDLL("libX11.so.6")
		x.XOpenDisplay.restype, x.XInternAtom.restype = ctypes.c_void_p, ctypes.c_ulong
		display = ctypes.c_void_p(x.XOpenDisplay(self.display.encode()))
		number = self.window()[0]
		event = ClientMessage(type=33, window=number, kind=x.XInternAtom(display, b"WM_PROTOCOLS", 0), format=32)
		event.data[0] = x.XInternAtom(display, b"WM_DELETE_WINDOW", 0)
		x.XSendEvent(display, ctypes.c_ulong(number), 0, ctypes.c_long(0), ctypes.byref(event))
		x.XCloseDisplay(display)

	def stop(self):
		self.process.send_signal(signal.SIGTERM)
		self.process.wait()


def until(what, seconds=povray.PATIENCE):
	end = time.time() + seconds
	while time.time() < end:
		found = what()
		if found:
			return found
		time.sleep(0.02)
	return None


class Preview:
	"""A render with +D, watched; leave it with end()."""

	def __init__(self, server, program, scene, words=""):
		self.server = server
		for _ in range(20): # on a busy machine POV-Ray may give up before it begins
			self.folder = tempfile.TemporaryDirectory()
			self.process = povray.start(program, scene, f"+D +WT1 +FN +W{WIDTH} +H{HEIGHT} {words}", self.folder.name, DISPLAY=server.display)
			until(lambda: server.window() or self.process.poll() is not None)
			if self.process.poll() is None or povray.NOT_STARTED not in povray.said(self.folder.name):
				break
		self.window = server.window()
		expect(self.window is not None, "no window")

	def moment(self):
		"""Lets it work for a moment, and holds it; whether it is there still. So a render is seen half-way however fast the machine is."""
		self.process.send_signal(signal.SIGCONT)
		time.sleep(0.02)
		self.process.send_signal(signal.SIGSTOP)
		return self.process.poll() is None

	def watch(self):
		"""All that was shown until povray waits; whether it does."""
		seen = []
		while self.moment() and "Press a key" not in povray.said(self.folder.name):
			seen.append(self.server.shown())
		self.process.send_signal(signal.SIGCONT)
		return seen, self.process.poll() is None

	def waits(self):
		time.sleep(0.4)
		return self.process.poll() is None

	def end(self):
		self.process.send_signal(signal.SIGCONT)
		code = povray.finish(self.process)
		picture = povray.picture(self.folder.name)
		self.folder.cleanup()
		return code, picture


def share(shown, final):
	return sum(max(abs(a - b) for a, b in zip(p, q)) <= 1 for p, q in zip(shown, final)) / len(final)


def off(shown, final):
	return max(abs(a - b) for p, q in zip(shown, final) for a, b in zip(p, q))


def paused(server, name, program, scene, words, leave):
	"""A render with +P: what was seen, against the file; leave is tried until it goes. Returns what may be compared."""
	preview = Preview(server, program, scene, words + " +P")
	seen, waiting = preview.watch()
	expect(waiting, name, "does not wait:", povray.said(preview.folder.name)[-200:])
	final = povray.picture(preview.folder.name).pixels # povray dithers the window, though not the file
	expect(until(lambda: off(server.shown(), final) <= 1, 30), name, "the window does not show what the file says")
	last, ends_with = server.shown(), None
	for how, act in leave:
		act()
		if how == leave[-1][0]: # by now it must
			until(lambda: preview.process.poll() is not None)
		if not preview.waits():
			ends_with = how
			break
	code, picture = preview.end()
	expect(code == 0 and picture is not None, name, "exits with", code, "and a picture" if picture else "without a picture")
	partly = [share(s, picture.pixels) for s in seen]
	steps = sum(0.05 < s < 0.95 for s in partly)
	print(f"{name}: window {preview.window[1:]}, {len(seen)} looks, {steps} at it partly filled; at last off the file by {off(last, final)}; left by {ends_with}, exit {code}")
	return preview.window[1:], code, ends_with, seen, picture, last


def seen(what, *words):
	"""paused(*words), once more, up to ten times, where a busy machine did not let what(it) be seen."""
	for _ in range(10):
		found = paused(*words)
		if what(found):
			break
	return found


def cancelled(server, name, program, scene, act):
	"""Its exit code and whether it leaves no picture, cancelled when there is something to see."""
	for _ in range(10):
		preview = Preview(server, program, scene)
		before = False
		while not before and preview.moment():
			before = any(any(p) for p in server.shown())
		if preview.process.poll() is None:
			act()
		# It looks for keys now and then: until then it gets a moment of each such time.
		for _ in range(40):
			if not preview.moment():
				break
			time.sleep(0.25)
		code, picture = preview.end()
		print(f"{name}: exit {code}, {'a' if picture else 'no'} picture")
		if code != 0: # else it was done before this busy machine let it be cancelled: once more
			break
	expect(before, name, "nothing was shown before")
	return code, picture is None


def check(server, program):
	key = lambda k: (k, lambda: server.tool("key", k))
	click = ("click", lambda: server.tool("click", "1"))
	close = ("close", server.close_window)
	# A letter and the cross are tried first: Debian's povray heeds neither in its pause.
	half_way = lambda found: any(0.05 < share(s, found[4].pixels) < 0.95 for s in found[3])
	ours = seen(half_way, server, "ours, hole", program, SLOW + BLACKHOLE, "", [key("x"), close, key("Return")])
	expect(half_way(ours), "it is not filled while it is rendered")
	black = sum(not any(p) for p in ours[4].pixels)
	expect(black > 100, "no shadow in the picture:", black)
	theirs = paused(server, "Debian's, no hole", STOCK, SLOW, "", [key("x"), close, key("Return")])
	plain = paused(server, "ours, no hole", program, SLOW, "", [key("x"), close, key("Return")])
	expect(ours[:3] == theirs[:3] == plain[:3], "another window, exit or way to leave than Debian's:", ours[:3], theirs[:3], plain[:3])
	expect((plain[4].pixels, plain[5]) == (theirs[4].pixels, theirs[5]), "another picture than Debian's, or another in the window")
	# All but the last pass paint squares of one colour, of 2 pixels at least.
	corners = [y * WIDTH + x for y in range(0, HEIGHT, 2) for x in range(0, WIDTH, 2)]
	flat = lambda s: sum(s[i] == s[i + 1] == s[i + WIDTH] == s[i + WIDTH + 1] and any(s[i]) for i in corners)
	coarsely = lambda found: any(flat(s) > 0.5 * len(corners) for s in found[3])
	mosaic = seen(coarsely, server, "ours, hole, mosaic", program, SLOW + BLACKHOLE, "+SP16 +EP2", [click])
	coarse, fine = max((flat(s) for s in mosaic[3]), default=0), flat(mosaic[5])
	print(f"mosaic: {coarse} of {len(corners)} squares were flat at some look, {fine} at last")
	expect(coarse > 0.5 * len(corners) and fine < 0.25 * len(corners), "no mosaic was seen")
	expect(mosaic[4].pixels == ours[4].pixels, "with a mosaic it is another picture")
	for how, act in (key("q"), close):
		ends = [cancelled(server, f"{name}, {how} while rendering", p, s, act) for name, p, s in
			(("ours, hole", program, SLOW + BLACKHOLE), ("Debian's, no hole", STOCK, SLOW))]
		expect(ends[0] == ends[1] == (2, True), how, "ends with", ends)
	# Without a server: Debian's SDL draws letters in the terminal, by libcaca; told to use X it complains, and there is no pause.
	for words, more in ("+D", {}), ("+D +P", {"SDL_VIDEODRIVER": "x11"}):
		ends = []
		for p, s in ((program, SCENE + BLACKHOLE), (STOCK, SCENE)):
			with tempfile.TemporaryDirectory() as folder:
				code = povray.finish(povray.start(p, s, f"{words} +WT1 +FN +W{WIDTH} +H{HEIGHT}", folder, DISPLAY="", **more))
				ends.append((code, [line for line in povray.said(folder).splitlines() if "SDL" in line], povray.picture(folder) is not None))
		print(words, "without a server", more, ends[0])
		expect(ends[0] == ends[1] == (0, ends[0][1], True) and bool(ends[0][1]) == bool(more), "it ends otherwise than Debian's:", ends)


if len(sys.argv) != 2:
	sys.exit(__doc__)
povray.fetch_stock()
with tempfile.TemporaryDirectory() as screen:
	xvfb = Server(screen)
	try:
		check(xvfb, os.path.realpath(sys.argv[1]))
	finally:
		xvfb.stop()
sys.exit(povray.failures > 0)
