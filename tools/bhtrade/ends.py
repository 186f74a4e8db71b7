# SPDX-License-Identifier: AGPL-3.0-or-later
"""Reads what povray writes for Ray_Ends: where the rays of each pixel end."""

LEAST_WEIGHT = 0.05 # rays that can carry less of a pixel's light are left out, with all that comes of them


class Hole:
	"""What the file says of a hole; lengths in scene units, tolerance in radians."""

	def __init__(self, line):
		w = line.split()
		self.center = tuple(map(float, w[2:5]))
		self.radius, self.effect_radius, self.tolerance = float(w[6]), float(w[8]), float(w[10])
		self.method = w[12]


def read(path):
	"""The holes, and {(column, row): (kind, points)}. kind tells what each ray of the pixel met, in order, as something to
	compare; points are where: a place on an object, a unit direction at the sky, zeros in a horizon."""
	holes, pixels = [], {}
	at, kind, points = None, [], []
	with open(path) as file:
		for line in file:
			if line.startswith("# hole"):
				holes.append(Hole(line))
				continue
			cells = line.split(",")
			if not cells[0].isdigit() and not cells[0].startswith("-"):
				continue
			column, row, _, level, weight, end, thing, x, y, z = cells
			if (column, row) != at:
				if at:
					pixels[int(at[0]), int(at[1])] = tuple(kind), points
				at, kind, points = (column, row), [], []
			if float(weight) >= LEAST_WEIGHT:
				kind.append((level, end, thing))
				points.append((float(x), float(y), float(z)))
	if at:
		pixels[int(at[0]), int(at[1])] = tuple(kind), points
	return holes, pixels
