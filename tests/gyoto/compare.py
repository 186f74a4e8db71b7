#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The same sky by GYOTO and by us: compare.py POVRAY RAYS OUTDIR (compare.sh finds or builds RAYS, see rays.cpp).

The same pinhole camera of a static observer, 10 Rs and 3 Rs from the hole, in both programs; every pixel's fate and
the direction its light came from. GYOTO's are numbers; ours are read back from a sky whose colour is its direction.
Ends with a table, OUTDIR/beside.png, and 1 if anything disagrees.
"""
import array
import math
import os
import struct
import subprocess
import sys
import zlib

# What may differ, and why (radians). x = |b/b_c - 1|, b_c the critical impact parameter, of the nearer of two rays.
QUANTUM = 2.7e-5  # 16-bit colours: half a step is 1.53e-5 in each component, at most sqrt(3) times that in a direction
TOLERANCE = 1e-4  # sky.pov's, which we promise for every ray with x > 0.1 %
GYOTO_TOLERANCE = 1e-9  # of its integrator: directions within 1e-6 of those at 1e-12 for x > 0.1 %
# Our static frame has g(R) = 1 at the effect radius R (physics.md), which shows a static observer's picture enlarged
# about the hole's centre by 1/sqrt(1 - Rs/R): 0.05 % at R = 1000 Rs. That moves a ray by 1/(2R) of its b,
# its direction by up to (1 + 1/x)/(2R), as deflection goes like -ln x. It must vanish where R is large, and where
# GYOTO's screen is made 0.05 % smaller.


def limit(x, enlarged):
	return QUANTUM + TOLERANCE + enlarged * (1 + 1 / x)


def margin(enlarged):
	"""How near a ray may be for its fate to differ."""
	return 1e-5 + 2 * enlarged


SIZE = 160
THETA, PHI = 1.2, 0.7  # nowhere special, so that axes, signs, and GYOTO's poles are tried too
CAMERAS = [
	# name, r/Rs, (left, right, bottom, top) in tangents: shadow and Einstein ring within, nothing symmetric
	("10 Rs", 10, (-0.78, 0.86, -0.85, 0.79)),
	("3 Rs", 3, (-2.5, 2.7, -2.65, 2.55)),
]


def run(command, folder):
	try:
		done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=200)
	except (OSError, subprocess.TimeoutExpired) as e:
		sys.exit(f"compare.py: {e}")
	if done.returncode:
		sys.exit(f"compare.py: {' '.join(command)}\n{(done.stdout + done.stderr).decode(errors='replace')[-3000:]}")
	return done.stdout.decode(errors="replace")


def gyoto(rays, out, r, window):
	"""Per pixel: captured, b/b_c, the direction on our axes or None, the local direction (right, up, forward), drift."""
	pixels = []
	# GYOTO's M is half our Rs; its x, y, z are POV-Ray's -z, x, y.
	words = (2 * r, THETA, PHI, *window, SIZE, GYOTO_TOLERANCE)
	for line in run([rays, *map(repr, words)], out).splitlines():
		v = [float(word) for word in line.split()]
		pixels.append((v[0] == 1, v[1], None if v[0] == 1 else (v[3], v[4], -v[2]), (v[5], v[6], v[7]), v[8]))
	if len(pixels) != SIZE * SIZE:
		sys.exit(f"compare.py: {len(pixels)} rays from GYOTO")
	return pixels


def render(povray, out, r, window, **switches):
	"""The picture's 16-bit linear colours, a triple in [0, 1] for each pixel."""
	words = {"Theta": THETA, "Phi": PHI, "Distance": r, "Painted": 0, "Chords": 0, **switches}
	words.update(zip(("Window_Left", "Window_Right", "Window_Bottom", "Window_Top"), window))
	ppm = os.path.join(out, "sky.ppm")
	if os.path.exists(ppm):
		os.remove(ppm)
	scene = os.path.join(os.path.dirname(os.path.abspath(__file__)), "sky.pov")
	run([povray, f"+I{scene}", "+Osky.ppm", "+FP16", "File_Gamma=1.0", f"+W{SIZE}", f"+H{SIZE}", "-D", "-A", "+WT1"]
		+ [f"Declare={k}={v!r}" for k, v in words.items()], out)
	with open(ppm, "rb") as f:
		data = f.read()
	fields, at = [], 0
	while len(fields) < 4:
		line_end = data.index(b"\n", at)
		fields += data[at:line_end].split(b"#")[0].split()
		at = line_end + 1
	if fields != [b"P6", str(SIZE).encode(), str(SIZE).encode(), b"65535"]:
		sys.exit(f"compare.py: not the picture asked for: {fields}")
	values = array.array("H", data[at:])
	if sys.byteorder == "little":
		values.byteswap()
	return [tuple(v / 65535 for v in values[i:i + 3]) for i in range(0, len(values), 3)]


def decode(colour):
	"""The direction a colour stands for; None for black, which no direction has."""
	if max(colour) < 5e-4:
		return None
	return unit([((c - 0.001) / 0.998) * 2 - 1 for c in colour])


def unit(v):
	n = math.sqrt(dot(v, v))
	return tuple(x / n for x in v)


def dot(a, b):
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def angle(a, b):
	return 2 * math.asin(min(1, math.dist(a, b) / 2))


def axes():
	"""The camera's right, up, forward, as in sky.pov."""
	st, ct, sp, cp = math.sin(THETA), math.cos(THETA), math.sin(PHI), math.cos(PHI)
	return (cp, 0, sp), (-ct * sp, st, ct * cp), (-st * sp, -ct, st * cp)


def tangents(window):
	"""Each pixel's place on the plane at distance 1."""
	left, right, bottom, top = window
	for j in range(SIZE):
		for i in range(SIZE):
			yield left + (right - left) * (i + 0.5) / SIZE, top + (bottom - top) * (j + 0.5) / SIZE


def shadow_and_ring(window, directions, edge):
	"""Half-angles: the last black and the first bright pixel, and where one sees the sky exactly behind the hole (a
	parabola through the signed angle from there, for |angle| < 0.1; not its further images at the shadow's edge)."""
	right, up, forward = axes()
	inner, outer, points = 0, math.inf, []
	for (x, y), d in zip(tangents(window), directions):
		psi = math.atan(math.hypot(x, y))
		if d is None:
			inner = max(inner, psi)
			continue
		outer = min(outer, psi)
		if dot(d, forward) > math.cos(0.1) and psi > 1.1 * edge:
			side = unit([x * r + y * u for r, u in zip(right, up)])
			points.append((math.atan2(dot(d, side), dot(d, forward)), psi))
	# least squares, psi = c0 + c1 t + c2 t^2
	s = [sum(t ** k for t, _ in points) for k in range(5)]
	m = [[s[i + k] for k in range(3)] + [sum(p * t ** i for t, p in points)] for i in range(3)]
	for i in range(3):
		for j in range(i + 1, 3):
			f = m[j][i] / m[i][i]
			m[j] = [a - f * b for a, b in zip(m[j], m[i])]
	c2 = m[2][3] / m[2][2]
	c1 = (m[1][3] - m[1][2] * c2) / m[1][1]
	c0 = (m[0][3] - m[0][2] * c2 - m[0][1] * c1) / m[0][0]
	return inner, outer, c0


def paint(d):
	"""sky.pov's Painted=1, for a direction."""
	if d is None:
		return 0, 0, 0
	cell = (math.floor(math.atan2(d[0], d[2]) * 12 / math.pi) + math.floor(math.asin(max(-1, min(1, d[1]))) * 12 / math.pi)) % 2
	if dot(d, axes()[2]) >= math.cos(math.radians(3)):
		return 0.999, 0.999, 0.999
	return tuple(0.001 + 0.998 * (0.5 + 0.5 * c) * (1 - 0.6 * cell) for c in d)


def srgb(c):
	return round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055))


def png(name, rows, zoom=2):
	"""rows of 8-bit triples; every pixel becomes a square of zoom by zoom."""
	def chunk(kind, body):
		return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
	lines = [b"\0" + b"".join(bytes(c) * zoom for c in row) for row in rows]
	with open(name, "wb") as f:
		f.write(b"\x89PNG\r\n\x1a\n"
			+ chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]) * zoom, len(rows) * zoom, 8, 2, 0, 0, 0))
			+ chunk(b"sRGB", b"\0") + chunk(b"IDAT", zlib.compress(b"".join(line * zoom for line in lines), 9)) + chunk(b"IEND", b""))


def main():
	if len(sys.argv) != 4:
		sys.exit(__doc__.splitlines()[0])
	povray, rays, out = map(os.path.abspath, sys.argv[1:])
	os.makedirs(out, exist_ok=True)
	failures, beside = [], []

	def demand(holds, what):
		if not holds:
			failures.append(what)

	print(f"{'':42}{'black pixels':>15}{'differ':>8}   angle between escape directions, microradians")
	print(f"{'':42}{'GYOTO':>7}{'ours':>8}{'':8}{'median':>9}{'99 %':>9}{'max':>9}{'max':>10}{'of its limit':>14}")
	print(f"{'':42}{'':7}{'':8}{'':8}{'x > 1 %':>9}{'x > 1 %':>9}{'x > 1 %':>9}{'x > 0.1 %':>10}{'x > 0.1 %':>14}")
	edges = []
	for name, r, window in CAMERAS:
		print(f"static observer at {name}")
		# The cameras are the same: without the hole, the sky must show the directions GYOTO's observer looks in.
		plain = gyoto(rays, out, r, window)
		seen = [decode(c) for c in render(povray, out, r, window, Effect=0)]
		worst = max(angle(s, tuple(sum(p * q for p, q in zip(p[3], e)) for e in zip(*axes()))) for s, p in zip(seen, plain))
		print(f"{'  no hole: our pixels, his screen':42}{'':51}{worst * 1e6:10.1f}{worst / (QUANTUM + 1e-6):14.2f}")
		demand(worst < QUANTUM + 1e-6, f"{name}: the cameras differ by {worst:.3g} rad")

		shrink = math.sqrt(1 - 1 / 1000)
		small = gyoto(rays, out, r, [x * shrink for x in window])
		worst = max(abs(p[4]) for p in plain + small)
		demand(worst < 1e-4, f"{name}: GYOTO loses its impact parameter, by {worst:.3g}")

		for label, his, enlarged, switches in (
			("R = 1000 Rs, his screen as it is", plain, 1 / 2000, {"Effect": 1000}),
			("R = 1000 Rs, his screen 0.05 % smaller", small, 0, {"Effect": 1000}),
			("the same, as chords past objects", small, 0, {"Effect": 1000, "Chords": 1}),
			("R = 1e6 Rs, his screen as it is", plain, 1 / 2e6, {"Effect": 1e6}),
		):
			ours = [decode(c) for c in render(povray, out, r, window, **switches)]
			where = f"{name}, {label}"
			differ = [abs(p[1] - 1) for p, d in zip(his, ours) if p[0] != (d is None)]
			bad = sum(x > margin(enlarged) for x in differ)
			demand(not bad, f"{where}: {bad} pixels black in one picture only, not near the shadow's edge")
			both = sorted((angle(p[2], d), abs(p[1] - 1) - enlarged) for p, d in zip(his, ours) if not p[0] and d is not None)
			clear = [a for a, x in both if x > 0.01]
			median, most, worst = clear[len(clear) // 2], clear[int(len(clear) * 0.99)], clear[-1]
			near = max(a for a, x in both if x > 0.001)
			share = max(a / limit(x, enlarged) for a, x in both if x > 0.001)
			print(f"{'  ' + label:42}{sum(p[0] for p in his):7}{sum(d is None for d in ours):8}{len(differ):8}"
				f"{median * 1e6:9.1f}{most * 1e6:9.1f}{worst * 1e6:9.1f}{near * 1e6:10.1f}{share:14.2f}")
			demand(share <= 1, f"{where}: a direction is off by {share:.3g} times its limit")

			# The shadow's edge has a formula (Synge, MNRAS 131, 463, 1966); the ring must be the same in both.
			if his is not plain:
				continue
			synge = math.tan(math.asin(1.5 * math.sqrt(3) / r * math.sqrt(1 - 1 / r)))
			rings = []
			for who, zoom, directions in (
				("GYOTO", 1, [p[2] for p in his]),
				("ours, " + label.split(",")[0], 1 / math.sqrt(1 - 2 * enlarged), ours),
			):
				edge = math.atan(synge * zoom)
				last, first, ring = shadow_and_ring(window, directions, edge)
				rings.append(math.atan(math.tan(ring) / zoom))
				line = f"{name + ': ' + who:42}" + "".join(f"{math.degrees(a):11.4f}" for a in (last, first, edge, ring))
				if line not in edges:
					edges.append(line)
				demand(last < edge + 1e-5 and first > edge - 1e-5,
					f"{where}: {who}: the shadow ends between {last:.6f} and {first:.6f} rad, not at {edge:.6f}")
			apart = abs(rings[0] - rings[1])
			demand(apart < QUANTUM + TOLERANCE, f"{where}: the rings are {apart:.3g} rad apart")

		his = [paint(p[2]) for p in plain]
		ours = render(povray, out, r, window, Effect=1000, Painted=1)
		his, ours = ([tuple(map(srgb, c)) for c in picture] for picture in (his, ours))
		differ = sum(max(abs(a - b) for a, b in zip(p, q)) > 8 for p, q in zip(his, ours)) / len(his)
		edges.append(f"{name}: {differ:.2%} of the painted pixels differ by more than 8 of 255")
		demand(differ < 0.02, f"{name}: {differ:.2%} of the painted pixels differ")
		his, ours = ([picture[i:i + SIZE] for i in range(0, len(picture), SIZE)] for picture in (his, ours))
		suffix = "" if not beside else "-" + name.replace(" ", "")
		png(os.path.join(out, f"gyoto{suffix}.png"), his)
		png(os.path.join(out, f"ours{suffix}.png"), ours)
		gap = [(128, 128, 128)] * 4
		if beside:
			beside += [[(128, 128, 128)] * (2 * SIZE + 4)] * 4
		beside += [a + gap + b for a, b in zip(his, ours)]

	png(os.path.join(out, "beside.png"), beside)
	os.remove(os.path.join(out, "sky.ppm"))
	print(f"\n{'half-angles, degrees':42}{'last black':>11}{'first sky':>11}{'formula':>11}{'ring':>12}")
	print("\n".join(edges))
	print(f"\nleft GYOTO, right ours: {os.path.join(out, 'beside.png')}")
	for failure in failures:
		print(f"FAILED: {failure}")
	return 1 if failures else 0


if __name__ == "__main__":
	sys.exit(main())
