# SPDX-License-Identifier: AGPL-3.0-or-later
"""Measures a scene at several settings, and recommends one."""
import math

import shift
from runs import BLOCK, Failed, Setting

METHODS = "rk4", "dopri5", "exact"
TOLERANCES = 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7
COARSE = 1e-5 # the finest of these that a reference at 1e-6 is good for
RADII = [round(d * 10 ** e) for e in range(1, 7) for d in (1, 2, 5)][:-2] # Schwarzschild radii, to 1e6
REFERENCE_RADIUS = 1e7 # Schwarzschild radii: 2e-7 radians short of no end
PIXELS = 12000 # to look at: 12 of them are the 0.1 % that may be worse
NOISE = 0.05 # times that differ by less are the same, or by less than a busy machine makes of one and the same


class Row:
	def __init__(self, povray, setting, error, own=False):
		self.povray, self.setting, self.error, self.own = povray, setting, error, own
		self.times = [] # of the whole picture, less starting; seconds, sorted

	@property
	def seconds(self):
		return self.povray.start + self.times[0]

	def scatter(self):
		"""By what part the second quickest time exceeds the quickest."""
		return (self.times[1] - self.times[0]) / max(1e-6, self.seconds)


class Trade:
	def __init__(self, povray, goal, limit, frames, tell):
		"""tell: called with a line on what is done next."""
		self.povray, self.goal, self.limit, self.frames, self.tell = povray, goal, limit, frames, tell
		self.rows, self.alone = [], {} # alone: what an effect radius costs in accuracy by itself
		tell("the scene")
		self.first = povray.time(Setting(), 10 ** 9) # not a block: only what comes before
		self.width, self.height = self.first.width, self.first.height
		self.blocks = math.ceil(self.width / BLOCK) * math.ceil(self.height / BLOCK)
		self.holes, _ = povray.ends(Setting(), 10 ** 9, self.width, self.height)
		if not self.holes:
			raise Failed("there is no black hole in the scene")
		some = self.measure(Setting(), 2000)
		self.threads = some.threads
		self.per_pixel = max(1e-7, some.parts["Trace"] * some.threads / max(1, some.pixels - self.first.pixels))

	def before(self):
		"""Seconds of a picture before it is traced."""
		return self.povray.start + self.first.before()

	def every(self, pixels):
		return max(1, int(self.blocks / max(1, pixels / BLOCK ** 2)))

	def measure(self, setting, pixels):
		return self.povray.time(setting, self.every(pixels))

	def refer(self, tolerance):
		self.tell("the reference")
		# Several holes share the room there is: their spheres are the scene's choice, and no error.
		self.far = REFERENCE_RADIUS if len(self.holes) == 1 else None
		# A heavy scene is looked at in fewer places.
		self.sample = self.every(min(PIXELS, max(PIXELS / 4, 5.0 / self.per_pixel)))
		_, pixels = self.povray.ends(Setting("exact", tolerance, self.far), self.sample, self.width, self.height, shift.FINE)
		if not pixels:
			raise Failed("no ray of the picture has an end")
		self.reference = shift.Reference(pixels)
		self.steep = len(self.reference.steep) * shift.FINE ** 2 / len(pixels)
		self.finest = tolerance

	def error(self, setting):
		self.tell(" ".join(setting.words()) or "the scene's own settings")
		_, pixels = self.povray.ends(setting, self.sample, self.width, self.height)
		return shift.Error(self.reference, pixels)

	def key(self, setting):
		"""The same for settings that come to the same."""
		h = self.holes[0]
		alike = all((o.method, o.tolerance) == (h.method, h.tolerance) for o in self.holes)
		return setting.method or (alike and h.method), setting.tolerance or (alike and h.tolerance), setting.effect_radius

	def add(self, setting, own=False):
		"""The setting's row, a new one if need be."""
		for row in self.rows:
			if self.key(row.setting) == self.key(setting):
				return row
		self.rows.append(Row(self.povray, setting, self.error(setting), own))
		return self.rows[-1]

	def own_radius(self):
		"""The least of the holes', in Schwarzschild radii."""
		return min(h.effect_radius / h.radius for h in self.holes)

	def find_radius(self):
		"""An effect radius (None: the scene's) that leaves most of what is allowed to the tolerance; the best there is, if none
		does. Alone, an effect radius costs about as much as it is small."""
		enough = 0.3 * self.limit if self.goal == "pixels" else 0.02
		tried = [(self.error(Setting("exact", self.finest, None)).most, self.own_radius(), None)]
		radii = [r for r in RADII if self.own_radius() < r] if self.far else []
		while tried[-1][0] > enough and radii:
			most, radius, _ = tried[-1]
			wanted = radius * most / enough if math.isfinite(most) else 10 * radius
			radius = next((r for r in radii if r >= wanted), radii[-1])
			radii = [r for r in radii if r > radius]
			tried.append((self.error(Setting("exact", self.finest, radius)).most, radius, radius))
		if self.far:
			self.alone.update((radius, most) for most, radius, _ in tried)
		good = [t for t in tried if t[0] <= enough]
		best = good[0] if good else min(tried, key=lambda t: (t[0], -t[1]))
		self.floor = best[0]
		return best[2]

	def along(self, method, radius, tolerances):
		"""Rows from coarse to fine, until finer is no use."""
		enough = 0.2 * self.limit if self.goal == "pixels" else 0.02
		for i, tolerance in enumerate(tolerances):
			most = self.add(Setting(method, tolerance, radius)).error.most
			if i >= 2 and most <= max(enough, 1.2 * self.floor):
				break

	def look(self):
		"""Fills rows; then times them."""
		self.refer(1e-6)
		self.add(Setting(), True)
		for finest, reference in ((COARSE, None), (0.0, 1e-8)):
			if reference:
				# Rarely: a narrow view, or mirrors that magnify. All is compared with a better reference then.
				self.refer(reference)
				old, self.rows = self.rows, []
				for row in old[:1] + old[-1:]:
					self.add(row.setting, row.own)
			radius = self.find_radius()
			self.along(METHODS[0], radius, [t for t in TOLERANCES if finest <= t])
			if min(row.error.most for row in self.rows) <= max(self.limit if self.goal == "pixels" else 0.1, 1.2 * self.floor):
				break
		run = [row.setting.tolerance for row in self.rows if not row.own][-3:]
		for method in METHODS[1:]:
			for tolerance in run:
				self.add(Setting(method, tolerance, radius))
		self.take_times(self.rows)
		best = self.choose()
		# A smaller sphere has fewer rays in it, if the camera is outside. Not worth a change unless it shows.
		if best and self.goal == "pixels" and self.far:
			r = best.setting.effect_radius or self.own_radius()
			for smaller in [q for q in reversed(RADII) if q < 0.9 * r][:4]:
				row = self.add(Setting(*self.key(best.setting)[:2], smaller))
				self.take_times([row])
				if row.error.most > self.limit or row.seconds > (1 - NOISE) * best.seconds:
					break
				best = row
		return best

	def take_times(self, rows):
		"""The least of three, turn and turn about."""
		pixels = min(max(0.15 / self.per_pixel, 3000), max(640, 2.0 / self.per_pixel))
		for turn in range(3):
			for row in rows:
				self.tell(f"times, {turn + 1} of 3")
				row.times = sorted([*row.times, self.measure(row.setting, pixels).whole(self.first.pixels)])

	def choose(self):
		"""The recommended row: of the cheapest that keep the goal, the most accurate; or of the most accurate, the cheapest. The
		scene's own settings, and its method, if there is nothing between them."""
		spread = sorted(row.scatter() for row in self.rows)
		noise = max(NOISE, spread[len(spread) // 2])

		def rank(row):
			changes = sum(a != b for a, b in zip(self.key(row.setting), self.key(Setting())))
			return not row.own, float(f"{row.error.most:.1e}"), changes, row.seconds

		if self.goal == "pixels":
			fit = [row for row in self.rows if row.error.most <= self.limit]
			fastest = min((row.seconds for row in fit), default=0)
			return min((row for row in fit if row.seconds <= (1 + noise) * fastest), key=rank, default=None)
		fit = [row for row in self.rows if row.seconds * self.frames <= self.limit]
		least = min((row.error.most for row in fit), default=0)
		return min((row for row in fit if row.error.most <= (1 + NOISE) * least), key=lambda row: row.seconds, default=None)

	def front(self):
		"""The rows that no other beats in both time and accuracy."""
		return [row for row in self.rows if not any(
			(o.seconds <= row.seconds and o.error.most < row.error.most) or (o.seconds < row.seconds and o.error.most <= row.error.most)
			for o in self.rows)]
