// SPDX-License-Identifier: AGPL-3.0-or-later
#include "extremes.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
using namespace blackhole;

namespace extremes {
namespace {

using Quad = __float128;

Quad root(Quad a) {
	if (!(a > 0))
		return 0;
	// Directions are subnormal or huge: to a double's range first, by powers of four.
	Quad scale = 1;
	for (; a > Quad(1e200); a /= Quad(0x1p600))
		scale *= Quad(0x1p300);
	for (; a < Quad(1e-200); a *= Quad(0x1p600))
		scale /= Quad(0x1p300);
	Quad y = std::sqrt(static_cast<double>(a));
	for (int i = 0; i < 3; i++)
		y = (y + a / y) / 2;
	return y * scale;
}

struct Exact {
	Quad r, r2, d2, s, h2; // |x|, |x|^2, |d|^2, x.d, |x cross d|^2
	explicit Exact(const Ray& ray) {
		const Quad a = ray.x.x, b = ray.x.y, c = ray.x.z, e = ray.d.x, f = ray.d.y, g = ray.d.z;
		const Quad i = b * g - c * f, j = c * e - a * g, k = a * f - b * e;
		r2 = a * a + b * b + c * c;
		d2 = e * e + f * f + g * g;
		s = a * e + b * f + c * g;
		h2 = i * i + j * j + k * k;
		r = root(r2);
	}
};

std::string words(const char* format, ...) {
	char text[400];
	va_list list;
	va_start(list, format);
	std::vsnprintf(text, sizeof text, format, list);
	va_end(list);
	return text;
}

bool finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// Steps that rk4.cpp may take, from its rule h = 1 / (k sqrt(1 + 3u) (1/0.55 + rate^(1/4)) + 1): every step but the last,
// which is cut, is at least that long, so their number is at most 1 + (the largest 1/h) S with S = phi / k the whole way in s.
// u <= 1 outside the horizon; inside, rate grows by a factor of at most 41 u^3 and u falls from its start.
double step_bound(const Path& path, double tolerance) {
	double u = 1;
	for (const Node& n : path.nodes())
		u = std::max(u, n.u);
	const Orbit& o = path.orbit();
	const double conditioning = std::min(1.0, std::max(1e-3, std::fabs(o.h / critical_b - 1)));
	double rate = 0.04 / (tolerance * conditioning);
	if (u > 1)
		rate *= 41 * u * u * u;
	const double inverse = o.k * std::sqrt(1 + 3 * u) * (1 / 0.55 + std::sqrt(std::sqrt(rate))) + 1;
	return 2 + inverse * path.nodes().back().s * (1 + 1e-9); // the nodes' s is a sum of rounded steps
}

// Chords: N grows by the trapezoidal rule, so by no more than its largest density times S; the last chord is a rest, a ramp
// adds five, and those that end because they sweep 1.8 radians no more than one each.
double chord_bound(const Path& path, const Ray& ray) {
	double u = 0;
	for (const Node& n : path.nodes())
		u = std::max(u, n.u);
	const Orbit& o = path.orbit();
	const double density = o.k * std::sqrt(1.5 * o.h / (8 * 0.4 * ray.settings.tolerance)) * u;
	return 2 + (ray.ramp ? 5 : 0) + path.swept() / 1.8 + density * path.nodes().back().s * (1 + 1e-9);
}

// Perpendicular distance of a point in the orbit's plane from the exact curve, over r: in ln r and phi, which keep angles, the
// curve's slope is -du / u. By du, not by 1 / u: near-radial u far out is the closed form's to an error of 5e-13 |du|.
double distance(const Exact_Orbit& exact, double phi, double r) {
	double best = 1e300;
	// Newton's step along the curve, for points so far off (tolerance 0.1) that the first order does not do.
	for (int i = 0; i < 3; i++) {
		const auto s = exact.at(phi > 0 ? phi : 0);
		const double off = s.u - 1 / r, size = std::hypot(s.u, s.du);
		best = std::min(best, std::fabs(off) / size);
		if (best < 1e-3)
			break;
		phi -= off * s.du / (size * size);
	}
	return best;
}

} // namespace

std::string Ray::text() const {
	return words("x {%a, %a, %a} d {%a, %a, %a} R %a tolerance %a ramp %d (r %.17g, R %.17g, tolerance %.3g)", x.x, x.y, x.z, d.x,
		d.y, d.z, settings.effect_radius, settings.tolerance, int(ramp), length(x), settings.effect_radius, settings.tolerance);
}

bool allowed(const Ray& ray) {
	const Settings& s = ray.settings;
	if (!finite(ray.x) || !finite(ray.d) || !(s.effect_radius > 1.5 && s.effect_radius <= 1e15) ||
		!(s.tolerance >= 1e-9 && s.tolerance <= 0.1))
		return false;
	const Exact e(ray);
	if (!(e.d2 > 0) || !(e.r > Quad(1e-6)) || !(e.r <= Quad(s.effect_radius) * (1 + Quad(4e-16))))
		return false;
	if (e.r > 1)
		return true;
	return e.s > 0 && e.h2 < e.r2 * e.r * e.d2;
}

Outcome witness(const Ray& ray, double& margin) {
	const Exact e(ray);
	// 1/b^2 against 4/27, times b^2's like: w^2 (u + 1/3) - s^2 / (r^2 h^2) with w = u - 2/3, which keeps its digits next to the
	// photon sphere, where b^2 - 27/4 would lose them.
	const Quad u = 1 / e.r, w = (Quad(1.5) - e.r) * u / Quad(1.5);
	const Quad barrier = w * w * (u + Quad(1) / 3) * e.r2 * e.h2, falls = e.s * e.s, beyond = barrier - falls;
	margin = barrier + falls > 0 ? std::fabs(double(beyond / (barrier + falls))) : 0;
	const Quad side = e.r - Quad(1.5);
	if (side == 0) {
		margin = double(e.s * e.s / (e.r2 * e.d2));
		return e.s > 0 ? Outcome::escaped : Outcome::captured;
	}
	if (side > 0)
		return e.s >= 0 || beyond > 0 ? Outcome::escaped : Outcome::captured;
	return e.s > 0 && beyond < 0 ? Outcome::escaped : Outcome::captured;
}

void Figures::print(const char* name) const {
	std::printf(
		"[ extremes ] %-14s %8ld rays (%4.1f %% captured, %4.1f %% within 0.1 %% of b_c, %ld nudged, closest %.1e), nodes: %.1f, "
		"at most %zu, %.2f of the bound; chords %.1f, at most %zu; swept %.2f; drift %.3f, chords off %.3f, direction %.3f of "
		"the tolerance (%ld rays), back %.3f (%ld)\n",
		name, rays, 100.0 * captured / rays, 100.0 * near / rays, nudged, closest, double(nodes) / rays, most_nodes, steps,
		double(chords) / rays, most_chords, swept, drift, off, direction, oracle, back_off, back);
}

std::string check(const Ray& ray, bool exact, Path& path, Figures& f) {
	const double R = ray.settings.effect_radius, tolerance = ray.settings.tolerance;
	double margin;
	const Outcome right = witness(ray, margin);
	f.rays++;
	if (margin > 0)
		f.closest = std::min(f.closest, margin);
	// Beyond 1e-30 quadruple precision is sure of itself; no pair of doubles is nearer but the exactly critical ones, and
	// those that sit on the photon sphere, which the margin is zero for.
	const bool outcome = classify(ray.x, ray.d) == Outcome::escaped;
	if (outcome != (right == Outcome::escaped) && (margin > 1e-30 || margin == 0))
		return words("classify() says %s, margin %g", outcome ? "escaped" : "captured", margin);
	const Launch launch(ray.x, ray.d);
	if ((launch.outcome == Outcome::escaped) != outcome)
		return "Launch's outcome is not classify()'s";
	if (!std::isfinite(launch.r) || !std::isfinite(launch.u) || !std::isfinite(launch.F2) || !std::isfinite(launch.B) ||
		!std::isfinite(launch.kappa) || !finite(launch.axis) || !std::isfinite(launch.across))
		return "Launch is not finite";
	Escape out;
	const bool escapes = escape(ray.x, ray.d, R, out);
	if (escapes != outcome)
		return "escape()'s outcome is not classify()'s";
	// On the photon sphere a ray may be outward by as little as the exponent's range has, 1e-632: it sweeps the logarithm of
	// that.
	if (escapes && !(out.phi >= 0 && out.phi < 1500))
		return words("escape() sweeps %g", out.phi);
	if (escapes && !(std::fabs(length(out.at) - 1) < 1e-14 && std::fabs(length(out.tangent) - 1) < 1e-14))
		return words("escape()'s place and tangent are of length %.17g and %.17g", length(out.at), length(out.tangent));

	// Deep inside the horizon the energy, 1, is what remains of |v|^2 = 1 + b^2 u^3: no more than eight digits may go.
	const bool lost = !launch.radial && launch.u > 1 && launch.u * launch.u * launch.u / launch.B > 1e8;
	if (!path.solve(ray.x, ray.d, ray.settings))
		return lost ? "" : words("solve() found no path (nudged %d, %zu nodes)", int(path.nudged()), path.nodes().size());
	if ((path.outcome() == Outcome::escaped) != outcome)
		return "the path's outcome is not classify()'s";
	const Orbit& orbit = path.orbit();
	const bool near = lost || std::fabs(orbit.h / critical_b - 1) < 1e-3;
	f.captured += !outcome;
	f.near += near;
	f.nudged += path.nudged();
	if (path.nudged() && !near)
		return words("nudged at b / b_c - 1 = %g", orbit.h / critical_b - 1);

	const std::vector<Node>& nodes = path.nodes();
	if (nodes.size() < 2)
		return "fewer than two nodes";
	for (std::size_t i = 0; i < nodes.size(); i++) {
		const Node& n = nodes[i];
		if (!std::isfinite(n.s) || !(n.u > 0) || !std::isfinite(n.u) || !std::isfinite(n.w) || !std::isfinite(n.a))
			return words("node %zu of %zu: s %g u %g w %g a %g", i, nodes.size(), n.s, n.u, n.w, n.a);
		if (i > 0 && !(n.s >= nodes[i - 1].s))
			return words("node %zu is behind the one before", i);
	}
	const double bound = step_bound(path, tolerance);
	f.nodes += long(nodes.size());
	f.most_nodes = std::max(f.most_nodes, nodes.size());
	f.steps = std::max(f.steps, double(nodes.size()) / bound);
	if (double(nodes.size()) > bound)
		return words("%zu nodes, bound %g", nodes.size(), bound);
	const double swept = path.swept(), drift = path.drift();
	f.swept = std::max(f.swept, swept);
	// path.cpp nudges what sweeps more; a step is no longer than 1.
	if (!(swept >= 0 && swept < 46))
		return words("swept %g", swept);
	if (!std::isfinite(drift))
		return "drift is not finite";
	const Vec3 end = path.end(), tangent = path.end_tangent();
	if (!finite(end) || !(std::fabs(length(tangent) - 1) < 1e-14))
		return words("end %g %g %g, tangent of length %g", end.x, end.y, end.z, length(tangent));
	const bool fell_back = path.started_inside() && path.emerged() == 0 && !outcome;
	const double last = outcome ? R : 1;
	if (!fell_back && !(std::fabs(length(end) / last - 1) < 1e-14))
		return words("ends at radius %.17g", length(end));
	if (path.started_inside() && outcome && !(path.emerged() > 0 || nodes[0].u == 1))
		return "escaped from inside and never emerged";
	if (!near) {
		f.drift = std::max(f.drift, drift / tolerance);
		if (!(drift <= tolerance))
			return words("drift %g", drift);
	}

	// Chords: joined, from the start (or the horizon) to the end.
	const bool known = exact && !near && (launch.radial || launch.B < 1e36);
	const Exact_Orbit curve(ray.x, ray.d);
	const double most = chord_bound(path, ray);
	const Vec3 normal = cross(orbit.e1, orbit.e2);
	Chords chords(path, tolerance, ray.ramp);
	Chord c{};
	std::size_t count = 0;
	Vec3 at = orbit.to_space(orbit.p);
	while (chords.next(c)) {
		if (++count > most)
			return words("more chords than %g", most);
		if (!finite(c.from) || !finite(c.to) || !std::isfinite(c.nearest) || !std::isfinite(c.farthest))
			return words("chord %zu is not finite", count);
		if (count == 1 && path.started_inside() ? std::fabs(length(c.from) - 1) > 1e-9 && orbit.u != 1 : length(c.from - at) != 0)
			return words("chord %zu does not join: it starts at %.17g %.17g %.17g", count, c.from.x, c.from.y, c.from.z);
		at = c.to;
		const double near_end = std::min(length(c.from), length(c.to)), far_end = std::max(length(c.from), length(c.to));
		if (c.nearest > near_end * (1 + 1e-14) || c.farthest < far_end * (1 - 1e-14))
			return words("chord %zu from %.17g to %.17g is said to be within %.17g and %.17g", count, length(c.from),
				length(c.to), c.nearest, c.farthest);
		const Vec3 way = c.to - c.from;
		const double l2 = dot(way, way), t = l2 > 0 ? std::min(1.0, std::max(0.0, -dot(c.from, way) / l2)) : 0;
		// A point of a long chord is no better than its length's last digits.
		if (length(c.from + t * way) < c.nearest - 1e-15 * (near_end + far_end))
			return words("chord %zu comes to %.17g, nearer than %.17g", count, length(c.from + t * way), c.nearest);
		const double s0 = nodes[c.at_from.piece].s + c.at_from.t * (nodes[c.at_from.piece + 1].s - nodes[c.at_from.piece].s);
		const double s1 = nodes[c.at_to.piece].s + c.at_to.t * (nodes[c.at_to.piece + 1].s - nodes[c.at_to.piece].s);
		if (!(s1 >= s0) || !(std::fabs(length(path.tangent(c.at_to)) - 1) < 1e-14))
			return words("chord %zu: marks %g to %g", count, s0, s1);
		if (known && !curve.radial())
			for (double part : {0.3, 0.5, 1.0}) {
				const Vec3 q = (1 - part) * c.from + part * c.to;
				// The angle swept at the point: that of its end on the path, and what is between them.
				const double back = std::atan2(dot(cross(q, c.to), normal), dot(q, c.to));
				const double off = distance(curve, orbit.k * s1 - back, length(q)) / tolerance;
				f.off = std::max(f.off, off);
				if (!(off < 1))
					return words("chord %zu of b %.17g is %g of the tolerance off at part %g, radius %.17g", count, orbit.h, off,
						part, length(q));
			}
	}
	f.chords += long(count);
	f.most_chords = std::max(f.most_chords, count);
	if (count > 0 && length(at - end) != 0)
		return "the last chord does not end where the path does";
	if (count == 0 && !fell_back && !(path.started_inside()))
		return "no chords";

	// Where it starts on the sphere, along it, a last digit of r is worth its root.
	const double graze = orbit.r >= R * (1 - 1e-12) ? 4e-16 / (std::sqrt(launch.F2) * launch.r + 1e-8) : 0;
	if (known && outcome) {
		f.oracle++;
		const double direction = length(tangent - out.tangent) / tolerance, off = length(end - R * out.at) / (R * tolerance);
		f.direction = std::max(f.direction, direction);
		if (!(direction < 1 && off < 1 + (1e-14 + graze) / tolerance))
			return words("exit off by %g of the tolerance in direction, %g in place", direction, off);
	}
	// Back from the exit, where it began on the sphere too. Each way keeps the tolerance by itself.
	if (known && outcome && orbit.r >= R * (1 - 1e-15) && dot(ray.x, ray.d) < 0) {
		Path other;
		Settings settings = ray.settings;
		if (!other.solve(end, -tangent, settings))
			return "no path back";
		if (other.outcome() != Outcome::escaped)
			return "the path back is captured";
		f.back++;
		const double off = length(other.end() - ray.x) / (R * tolerance);
		f.back_off = std::max(f.back_off, off);
		// The tangent's last digits are worth 1e-16 R of b.
		const double digits = 1e-15 * R / (orbit.h * std::min(1.0, std::fabs(orbit.h / critical_b - 1)));
		if (!(off < 2 + (digits + graze) / tolerance))
			return words("back off by %g of the tolerance", off);
	}
	return {};
}

} // namespace extremes
