# SPDX-License-Identifier: AGPL-3.0-or-later
"""Draws docs/trade.svg and fills in docs/accuracy.md's tables from docs/trade.csv and docs/trade_pictures.csv, for bench/trade.

  trade_plot.py DOCS          writes both
  trade_plot.py DOCS --check  says whether they are what the CSV files give
"""
import csv
import math
import os
import sys

DEFAULT = ("rk4", 1e-4, 1e4)
GOAL = 0.5
DIRECT = ("far", "middle", "near", "disc", "wall", "floor", "close")
MIRRORS = ("mirror", "twice")
METHODS = {"rk4": "#1f6feb", "dopri5": "#d9730d", "exact": "#2a8a57", "euler-r": "#8a8781", "euler": "#bdbab4"}
NAMES = {"euler-r": "Euler, step times r", "euler": "Euler, fixed step"}


def rows(path):
	with open(path, encoding="utf-8") as f:
		for row in csv.DictReader(line for line in f if not line.startswith("#")):
			yield {k: v if k in ("scene", "method", "setting") else float(v) for k, v in row.items()}


class Trade:
	"""What was measured, by setting (method, tolerance or step, effect radius)."""

	def __init__(self, path):
		self.at = {}
		for r in rows(path):
			self.at.setdefault((r["method"], r["tolerance_or_step"], r["effect_radius"]), {})[r["scene"]] = r
		self.radii = sorted({s[2] for s in self.at if s[0] == "rk4"})
		self.tolerances = sorted({s[1] for s in self.at if s[0] == "rk4"}, reverse=True)

	def direct(self, setting):
		"""Mean time in the scenes without mirrors, and the worst of their 99.9 % errors."""
		scenes = [self.at[setting][name] for name in DIRECT]
		return sum(s["us_per_ray"] for s in scenes) / len(scenes), max(s["p999_px"] for s in scenes)

	def front(self):
		"""Settings that no other beats in both, left out where they gain less than a quarter."""
		points = sorted((self.direct(s), s) for s in self.at if all(name in self.at[s] for name in DIRECT))
		best, front = math.inf, []
		for (us, px), setting in points:
			if px < 0.75 * best:
				best = px
				front.append(((us, px), setting))
		return front


def number(x):
	return "%.2g" % x if x < 10 else "%.0f" % x


def words(setting):
	return NAMES[setting[0]] + " %g" % setting[1] if setting[0] in NAMES else "%s %g" % setting[:2]


class Panel:
	"""Logarithmic axes in a rectangle of the picture."""

	def __init__(self, out, box, x, y, title, x_name, y_name):
		self.out, self.box, self.x, self.y = out, box, x, y
		left, top, w, h = box
		self.text(left, top - 26, title, size=15, weight=600, fill="#24292f")
		for (low, high), place, across in ((x, self.px, True), (y, self.py, False)):
			for e in range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1):
				p, name = place(10.0 ** e), "%g" % 10.0 ** e if -3 <= e <= 4 else "1e%d" % e
				ends = (p, top, p, top + h) if across else (left, p, left + w, p)
				self.line([ends[:2], ends[2:]], "#e4e2dd", 1)
				if across:
					self.text(p, top + h + 16, name, anchor="middle")
				else:
					self.text(left - 8, p + 4, name, anchor="end")
		self.text(left + w / 2, top + h + 36, x_name, anchor="middle")
		self.text(left, top - 9, y_name)

	def px(self, v):
		low, high = self.x
		return self.box[0] + self.box[2] * math.log(v / low) / math.log(high / low)

	def py(self, v):
		low, high = self.y
		v = min(max(v, low), high)
		return self.box[1] + self.box[3] * (1 - math.log(v / low) / math.log(high / low))

	def text(self, x, y, s, size=12, anchor="start", weight=400, fill="#57534e"):
		self.out.append('<text x="%.1f" y="%.1f" font-size="%d" text-anchor="%s" font-weight="%d" fill="%s">%s</text>'
			% (x, y, size, anchor, weight, fill, s.replace("&", "&amp;").replace("<", "&lt;")))

	def line(self, points, colour, width=2, dash=""):
		self.out.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="%g"%s/>' % (
			" ".join("%.1f,%.1f" % p for p in points), colour, width, ' stroke-dasharray="%s"' % dash if dash else ""))

	def dot(self, x, y, colour, r=3.5):
		self.out.append('<circle cx="%.1f" cy="%.1f" r="%g" fill="%s" stroke="#fff" stroke-width="1"/>' % (x, y, r, colour))

	def curve(self, points, colour, dash=""):
		places = [(self.px(x), self.py(y)) for x, y in points]
		self.line(places, colour, 2, dash)
		for p in places:
			self.dot(*p, colour)
		return places

	def goal(self, left=False):
		y = self.py(GOAL)
		self.line([(self.box[0], y), (self.box[0] + self.box[2], y)], "#cf222e", 1, "5 4")
		x, anchor = (self.box[0] + 4, "start") if left else (self.box[0] + self.box[2] - 4, "end")
		self.text(x, y - 5, "half a pixel", anchor=anchor, fill="#cf222e")

	def here(self, x, y):
		x, y = self.px(x), self.py(y)
		self.out.append('<circle cx="%.1f" cy="%.1f" r="9" fill="none" stroke="#24292f" stroke-width="2"/>' % (x, y))
		self.text(x - 14, y + 22, "the default", anchor="end", weight=600, fill="#24292f")


def spread(labels, apart=15, lowest=math.inf):
	"""Moves labels (y, ...) down so that they do not overlap, and up where they would be below the lowest."""
	labels, places, last = sorted(labels), [], -math.inf
	for label in labels:
		last = max(label[0], last + apart)
		places.append(last)
	for i in reversed(range(len(places))):
		places[i] = min(places[i], lowest)
		lowest = places[i] - apart
	return [(y,) + label[1:] for y, label in zip(places, labels)]


def draw(trade):
	out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 960 900" font-family="system-ui, sans-serif">',
		"<!-- SPDX-License-Identifier: AGPL-3.0-or-later. Made by bench/trade. -->", '<rect width="960" height="900" fill="#fff"/>']
	method, tolerance, radius = DEFAULT
	error = "error of 99.9 % of the pixels is less, pixels of 1920 x 1080"
	p = Panel(out, (70, 70, 650, 400), (0.2, 200), (4e-3, 2e3), "Time against error: seven scenes, the worst of them", "CPU microseconds a ray", error)
	p.line([(p.px(us), p.py(px)) for (us, px), _ in trade.front()], "#fff1c2", 16)
	p.text(p.px(0.36), p.py(200), "broad: the front", fill="#9a7b1f")
	p.goal()
	labels = []
	steps = sorted({s[1:] for s in trade.at if s[0] == "euler-r" and s[2] == 1e4}, reverse=True)
	for name, dash, settings in (
			[("euler", "", [("euler", h, 100.0) for h in sorted({s[1] for s in trade.at if s[0] == "euler" and s[2] == 100}, reverse=True)])] +
			[("euler-r", "", [("euler-r",) + s for s in steps])] +
			[("rk4", "3 4", [("rk4", t, 1e3) for t in trade.tolerances])] +
			[(m, "", [(m, t, radius) for t in trade.tolerances]) for m in ("exact", "dopri5", "rk4")]):
		places = p.curve([trade.direct(s) for s in settings], METHODS[name], dash)
		end = places[-1]
		what = NAMES.get(name, name) + (", effect_radius 100 Rs" if name == "euler" else ", effect_radius 1000 Rs" if dash else "")
		labels.append((end[1] + 4, end[0] + 10, what, METHODS[name]))
		if name in ("rk4", "euler-r") and not dash:
			for s, place in zip(settings, places):
				if name == "euler-r" or s[1] in (5e-2, 1e-2, 1e-3, 1e-4, 1e-6):
					p.text(place[0] - 8, place[1] + 12, "%g" % s[1], size=10, anchor="end", fill=METHODS[name])
	for y, x, what, colour in spread(labels):
		p.text(x, y, what, fill=colour, weight=600)
	p.here(*trade.direct(DEFAULT))

	for box, points, x, title, x_name, name in (
			((70, 590, 330, 240), trade.radii, radius, "Effect radius, at tolerance %g" % tolerance, "effect_radius, Rs", 2),
			((500, 590, 330, 240), trade.tolerances, tolerance, "Tolerance, at effect_radius 10,000 Rs", "tolerance, radians", 1)):
		q = Panel(out, box, (min(points), max(points)), (1e-2, 1e2), title, x_name, "the same, for each scene")
		q.goal(left=name == 2)
		labels = []
		for k, scene in enumerate(DIRECT + MIRRORS[:1]):
			colour = ("#0b3d91", "#1f6feb", "#6aa9ff", "#d9730d", "#2a8a57", "#a8a116", "#8250df", "#bdbab4")[k]
			part = "p99_px" if scene in MIRRORS else "p999_px"
			curve = [(v, trade.at[(method, v, radius) if name == 1 else (method, tolerance, v)][scene][part]) for v in sorted(points)]
			places = [(q.px(a), q.py(b)) for a, b in curve]
			q.line(places, colour, 1.8, "4 3" if scene in MIRRORS else "")
			labels.append((places[-1][1] + 4, scene + (", 99 %" if scene in MIRRORS else ""), colour))
		for y, scene, colour in spread(labels, 13, box[1] + box[3] + 4):
			q.text(box[0] + box[2] + 6, y, scene, fill=colour)
		q.line([(q.px(x), box[1]), (q.px(x), box[1] + box[3])], "#24292f", 1)
		q.text(q.px(x) + 4, box[1] + 14, "default", fill="#24292f")
	return "\n".join(out + ["</svg>\n"])


def table(head, lines):
	return "\n".join("| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head)] + lines)


def tables(trade, pictures):
	method, tolerance, radius = DEFAULT
	scenes = []
	for name in DIRECT + MIRRORS:
		r = trade.at[DEFAULT][name]
		scenes.append([name] + [number(r[k]) for k in ("us_per_ray", "median_px", "p99_px", "p999_px", "clear_max_px")] +
			["%.0e" % r["median_rad"], "%.2g %%" % (100 * r["band"])])
	front = [[number(us), number(px), words(s), "%g" % s[2], "yes" if s == DEFAULT else ""] for (us, px), s in trade.front()]
	return {
		"scenes": table(["scene", "us/ray", "median", "99 %", "99.9 %", "most", "median, radians", "beside b_c"], scenes),
		"front": table(["us/ray", "99.9 %, px", "method, tolerance or step", "effect_radius, Rs", "default"], front),
		"pictures": table(["setting", "CPU seconds", "over the default"], [[r["setting"], "%.2f" % r["cpu_s"],
			"%.2f" % (r["cpu_s"] / pictures[0]["cpu_s"])] for r in pictures]),
	}


def filled(text, parts):
	for name, part in parts.items():
		begin, end = "<!-- bench/trade: %s -->\n" % name, "<!-- end -->"
		head, rest = text.split(begin)
		text = head + begin + part + "\n" + end + rest.split(end, 1)[1]
	return text


def main(docs, check):
	trade = Trade(os.path.join(docs, "trade.csv"))
	pictures = list(rows(os.path.join(docs, "trade_pictures.csv")))
	page = os.path.join(docs, "accuracy.md")
	with open(page, encoding="utf-8") as f:
		text = f.read()
	for path, now in ((page, filled(text, tables(trade, pictures))), (os.path.join(docs, "trade.svg"), draw(trade))):
		if check:
			with open(path, encoding="utf-8") as f:
				if f.read() != now:
					sys.exit("%s is not what docs/trade*.csv give: bench/trade --draw makes it" % path)
			continue
		with open(path, "w", encoding="utf-8") as f:
			f.write(now)


if __name__ == "__main__":
	main(sys.argv[1], "--check" in sys.argv)
