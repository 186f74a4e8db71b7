# SPDX-License-Identifier: AGPL-3.0-or-later
"""How far a picture is off, in pixels.

A pixel sees something: its rays end at places on objects, at directions of the sky. In another picture of the same scene the
same pixel sees something a little different. Its error is the shift on the screen that explains the difference: how far from
the pixel's middle the reference sees that. The reference is rendered FINE times finer each way, so it knows how what is seen
changes from a third of a pixel to the next (a matrix for each ray; its inverse takes a difference to a shift), and where,
within a third of a pixel, one object ends and another begins.
"""
import math

FINE = 3 # odd, so that a pixel's middle is that of one of the reference's
REACH = 1.5 # pixels: as far as what a pixel sees is looked for when the reference sees another thing there
STEEP = 3 # times the usual change,
BENT = 0.15 # of which that much is a bend: there the reference is no straight line from one third of a pixel to the next
FAINT = 1e-8 # of the larger square of a singular value: a direction along which the reference does not change explains nothing

NEAR = range(-int(REACH * FINE), int(REACH * FINE) + 1)
OFFSETS = sorted((math.hypot(x, y) / FINE, x, y) for x in NEAR for y in NEAR if 0 < math.hypot(x, y) <= REACH * FINE)


def inverse(a, b):
	"""The pseudo-inverse of the 3 x 2 matrix with columns a and b, as two rows."""
	aa, ab, bb = sum(x * x for x in a), sum(x * y for x, y in zip(a, b)), sum(y * y for y in b)
	# Eigenvectors of the 2 x 2 matrix of products: the directions on the screen along which things change most and least.
	half = math.hypot(0.5 * (aa - bb), ab)
	mean = 0.5 * (aa + bb)
	angle = 0.5 * math.atan2(2 * ab, aa - bb)
	rows = [[0.0] * 3, [0.0] * 3]
	for value, u, v in ((mean + half, math.cos(angle), math.sin(angle)), (mean - half, -math.sin(angle), math.cos(angle))):
		if value > FAINT * (mean + half) and value > 0:
			for i in range(3):
				along = (u * a[i] + v * b[i]) / value
				rows[0][i] += u * along
				rows[1][i] += v * along
	return rows


class Reference:
	def __init__(self, pixels):
		"""pixels: as ends.read has them, of a picture FINE times as wide and high."""
		self.pixels = pixels
		self.inverses = {}
		self.steep = self.find_steep()

	def find_steep(self):
		"""The pixels (by their middles) where the change from one third of a pixel to the next says nothing of what lies between:
		it is much more than elsewhere for such things, and bends. So it is at the edge of a shadow, where images of the whole sky
		crowd, and at the limbs of what is round."""
		steps = {}
		for (x, y), (kind, here) in self.pixels.items():
			if x % FINE != FINE // 2 or y % FINE != FINE // 2:
				continue
			for dx, dy in ((1, 0), (0, 1)):
				after, before = self.pixels.get((x + dx, y + dy)), self.pixels.get((x - dx, y - dy))
				if after and before and after[0] == before[0] == kind:
					for name, p, a, b in zip(kind, here, after[1], before[1]):
						bend = math.dist((a[0] + b[0], a[1] + b[1], a[2] + b[2]), (2 * p[0], 2 * p[1], 2 * p[2]))
						steps.setdefault(name, []).append((math.dist(p, a) + math.dist(p, b), bend, x, y))
		steep = set()
		for of_name in steps.values():
			usual = sorted(of_name)[len(of_name) // 2][0]
			steep.update((x, y) for step, bend, x, y in of_name if step > STEEP * usual and bend > BENT * step)
		return steep

	def slope(self, x, y, dx, dy):
		"""What changes towards (dx, dy), for each ray and a whole pixel's step; None if something else is seen on both sides."""
		kind, here = self.pixels[x, y]
		after, before = self.pixels.get((x + dx, y + dy)), self.pixels.get((x - dx, y - dy))
		after = after[1] if after and after[0] == kind else None
		before = before[1] if before and before[0] == kind else None
		if after is None and before is None:
			return None
		scale = FINE / ((after is not None) + (before is not None))
		return [[scale * (q - p) for p, q in zip(b, a)] for b, a in zip(before or here, after or here)]

	def inverses_at(self, x, y):
		if (x, y) not in self.inverses:
			right, down = self.slope(x, y, 1, 0), self.slope(x, y, 0, 1)
			still = [[0.0] * 3] * len(self.pixels[x, y][1])
			self.inverses[x, y] = [inverse(a, b) for a, b in zip(right or still, down or still)]
		return self.inverses[x, y]

	def step(self, x, y, ray, q):
		"""From there, going on in a straight line, to where the reference sees this point; pixels across and down."""
		p = self.pixels[x, y][1][ray]
		r, s = self.inverses_at(x, y)[ray]
		d0, d1, d2 = q[0] - p[0], q[1] - p[1], q[2] - p[2]
		return r[0] * d0 + r[1] * d1 + r[2] * d2, s[0] * d0 + s[1] * d1 + s[2] * d2

	def explain(self, x, y, points, from_x=0.0, from_y=0.0):
		"""The largest of the rays' shifts, from a place so far off to where the reference sees these points."""
		worst = 0.0
		for ray, q in enumerate(points):
			u, v = self.step(x, y, ray, q)
			worst = max(worst, math.hypot(from_x + u, from_y + v))
		return worst

	def look(self, x, y, points):
		"""The same for a pixel that met what the reference meets there, where a straight line is no good: places beside it are
		tried, from where the rest of the shift is less than a third of a pixel. Beside a caustic that is much nearer."""
		kind = self.pixels[x, y][0]
		beside = [(dx, dy) for _, dx, dy in OFFSETS if self.pixels.get((x + dx, y + dy), (None,))[0] == kind]
		worst = 0.0
		for ray, q in enumerate(points):
			best = math.hypot(*self.step(x, y, ray, q))
			if best > 1 / FINE:
				for dx, dy in beside:
					u, v = self.step(x + dx, y + dy, ray, q)
					if math.hypot(u, v) <= 1 / FINE:
						best = min(best, math.hypot(dx / FINE + u, dy / FINE + v))
			worst = max(worst, best)
		return worst

	def nearest(self, x, y, kind, points):
		"""A bound on the shift of a pixel that met another thing than the reference: how far from there that is seen at all, in
		thirds of a pixel, or as far as going on from there in a straight line says; infinite if it is nowhere within REACH."""
		best = math.inf
		for far, dx, dy in OFFSETS:
			if far - 1 / FINE >= best:
				break
			there = self.pixels.get((x + dx, y + dy))
			if there and there[0] == kind:
				best = min(best, max(far - 1 / FINE, self.explain(x + dx, y + dy, points, dx / FINE, dy / FINE)))
		return best


def around(column, row):
	return [(c, r) for c in range(column - 1, column + 2) for r in range(row - 1, row + 2)]


def shifts(reference, pixels):
	"""{(column, row): (error, met the same)} of those pixels that the reference has."""
	found, others = {}, []
	for (column, row), (kind, points) in pixels.items():
		x, y = FINE * column + FINE // 2, FINE * row + FINE // 2
		there = reference.pixels.get((x, y))
		if there is None:
			continue
		if there[0] == kind:
			found[column, row] = reference.explain(x, y, points), True
		else:
			others.append((column, row, x, y, kind, points, there[0]))
	# Where that many are far off, a closer look changes no verdict.
	far = [at for at, (error, _) in found.items() if error > 1 / FINE]
	if len(far) < 0.02 * len(pixels):
		for column, row in far:
			found[column, row] = reference.look(FINE * column + FINE // 2, FINE * row + FINE // 2, pixels[column, row][1]), True
	# Those on steep ground go where those beside them go.
	plain = {at: error for at, (error, _) in found.items() if (FINE * at[0] + FINE // 2, FINE * at[1] + FINE // 2) not in reference.steep}
	left = [at for at in found if at not in plain]
	while left:
		judged = {}
		for at in left:
			beside = [plain[other] for other in around(*at) if other in plain and pixels[other][0] == pixels[at][0]]
			if beside:
				judged[at] = max(beside)
				found[at] = judged[at], True
		plain.update(judged)
		left = [at for at in left if at not in judged] if judged else []
	edges = {}
	for column, row, x, y, kind, points, should in others:
		bound = reference.nearest(x, y, kind, points)
		# The edge between the two went where what is on its sides went, if both sides are seen nearby in this picture.
		sides = {kind: None, should: None}
		for at in around(column, row):
			if at in found and pixels[at][0] in sides:
				sides[pixels[at][0]] = max(found[at][0], sides[pixels[at][0]] or 0.0)
		if None not in sides.values():
			bound = min(bound, max(sides.values()))
		edges[column, row] = bound, False
	found.update(edges)
	return found


class Error:
	"""Of a picture: errors in pixels at half of the pixels and at 99.9 %; the shares that met another thing, and of those
	that saw what the reference sees nowhere near."""

	def __init__(self, reference, pixels):
		found = shifts(reference, pixels).values()
		errors = sorted(e for e, _ in found)
		self.count = len(errors)
		self.median = errors[len(errors) // 2]
		self.most = errors[math.ceil(0.999 * len(errors)) - 1]
		self.other = sum(not same for _, same in found) / len(errors)
		self.lost = sum(math.isinf(e) for e in errors) / len(errors)
