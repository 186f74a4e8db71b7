# SPDX-License-Identifier: AGPL-3.0-or-later
"""The outcome as a table, and as JSON."""
import json
import math

from runs import number


def described(trade, setting):
	"""method, tolerance, effect radius in Schwarzschild radii, as text; holes that differ: a range."""
	def span(values):
		return number(min(values)) if min(values) == max(values) else f"{number(min(values))} to {number(max(values))}"

	return (setting.method or "/".join(sorted({h.method for h in trade.holes})),
		number(setting.tolerance) if setting.tolerance else span([h.tolerance for h in trade.holes]),
		number(setting.effect_radius) if setting.effect_radius else span([h.effect_radius / h.radius for h in trade.holes]))


def seconds(value):
	return f"{value:.3g} s" if value < 600 else f"{value / 60:.4g} min" if value < 36000 else f"{value / 3600:.4g} h"


def pixels(value):
	return "far off" if math.isinf(value) else number(float(f"{value:.2g}")) if value < 10 else f"{value:.0f}" if value < 100 else ">99"


def share(value):
	return "0" if value == 0 else f"{100 * value:.2g} %"


def table(trade, best, every_row):
	shown = [row for row in trade.rows if every_row or row.own or row is best or row in trade.front()]
	lines = [("time", "median", "99.9 %", "other", "lost", "method", "tolerance", "effect_radius", "")]
	for row in sorted(shown, key=lambda row: row.seconds):
		marks = [m for m, on in (("the scene's own", row.own), ("recommended", row is best)) if on]
		lines.append((seconds(row.seconds * trade.frames), pixels(row.error.median), pixels(row.error.most), share(row.error.other),
			share(row.error.lost), *described(trade, row.setting), ", ".join(marks)))
	widths = [max(len(line[i]) for line in lines) for i in range(9)]
	return "\n".join("  ".join(c.rjust(w) if i < 5 else c.ljust(w) for i, (c, w) in enumerate(zip(line, widths))).rstrip() for line in lines)


def heading(trade, name, frame_words):
	film = f", {trade.frames} frames (errors of frame {frame_words[0].partition('=')[2]})" if trade.frames > 1 else ""
	steep = f"; {share(trade.steep)} of them on steep ground" if trade.steep else ""
	lines = [f"{name}, {trade.width} x {trade.height}{film}: errors in pixels, from {trade.rows[0].error.count} pixels{steep}",
		f"times for {trade.threads} thread(s), {seconds(trade.before())} of {'each frame' if trade.frames > 1 else 'them'} before tracing starts"]
	if not trade.far:
		lines.append("several holes: their effect radii are taken as they are")
	return "\n".join(lines)


def advice(trade, best):
	"""What to write into the scene, and what on the command line."""
	goal = f"--{trade.goal} {number(trade.limit)}"
	if best is None and trade.goal == "pixels":
		row = min(trade.rows, key=lambda row: row.error.most)
		most = "has more than 0.1 % of them far off" if math.isinf(row.error.most) else f"keeps them within {pixels(row.error.most)}"
		return (f"no setting keeps 99.9 % of the pixels within {number(trade.limit)}; the most accurate "
			f"({', '.join(described(trade, row.setting))} Rs) {most}")
	if best is None:
		row = min(trade.rows, key=lambda row: row.seconds)
		return (f"no setting takes {number(trade.limit)} s or less; the quickest ({', '.join(described(trade, row.setting))} Rs) "
			f"takes {seconds(row.seconds * trade.frames)}")
	s = best.setting
	if s.method is None and s.tolerance is None and s.effect_radius is None:
		return f"for {goal} the scene's own settings are right"
	lines = [f"for {goal}, in the scene:"]
	blocks = {block(trade, s, hole): hole for hole in trade.holes}
	for text, hole in blocks.items():
		lines.append(f"  {text}" + (f"   // for the hole at <{', '.join(map(number, hole.center))}>" if len(blocks) > 1 else ""))
	return "\n".join([*lines, "or on the command line:", "  " + " ".join(s.words())])


def block(trade, setting, hole):
	radius = f"  effect_radius {number(setting.effect_radius * hole.radius)}" if setting.effect_radius else ""
	return f'tolerance {number(setting.tolerance or hole.tolerance)}  method "{setting.method or hole.method}"{radius}'


def as_json(trade, best, name):
	def finite(value):
		return value if math.isfinite(value) else None

	def entry(row):
		s = row.setting
		return {"seconds": row.seconds * trade.frames, "median": finite(row.error.median), "most": finite(row.error.most),
			"other": row.error.other, "lost": row.error.lost, "own": row.own, "front": row in trade.front(),
			"method": s.method, "tolerance": s.tolerance, "effect_radius": s.effect_radius, "words": s.words()}

	return json.dumps({"scene": name, "width": trade.width, "height": trade.height, "frames": trade.frames, "threads": trade.threads,
		"pixels": trade.rows[0].error.count, "steep": trade.steep,
		"before": trade.before(), "goal": trade.goal, "limit": trade.limit,
		"holes": [vars(h) for h in trade.holes],
		"reference": {"method": "exact", "tolerance": trade.finest, "effect_radius": trade.far},
		"effect_radius_alone": {number(r): finite(e) for r, e in trade.alone.items()},
		"settings": [entry(row) for row in sorted(trade.rows, key=lambda row: row.seconds)], "recommended": entry(best) if best else None}, indent=1)
