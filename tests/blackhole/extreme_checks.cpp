// SPDX-License-Identifier: AGPL-3.0-or-later
#include "extremes.h"

#include <algorithm>
#include <optional>

using namespace blackhole;

namespace extremes {

// In ln r and phi, which keep angles, the curve's slope is -du / u. By du, not by 1 / u: near-radial u far out is the closed
// form's to an error of 5e-13 |du|.
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

namespace {

bool finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

double largest_u(const Path& path) {
	double u = 0;
	for (const Node& n : path.nodes())
		u = std::max(u, n.u);
	return u;
}

// Steps that a method may take: every step but the last, which is cut, is at least as long as the method's rule has it where u
// and its rate are largest, so their number is at most 1 + S / that, with S = phi / k the whole way in s.
double step_bound(const Path& path, const Settings& settings) {
	const Orbit& o = path.orbit();
	const double u = std::max(1.0, largest_u(path)), frequency = o.k * std::sqrt(1 + 3 * u);
	// rk4.cpp's h = 1 / (k sqrt(1 + 3u) (1/0.55 + rate^(1/4)) + 1). u <= 1 outside the horizon; inside, rate grows by a factor
	// of at most 41 u^3 and u falls from its start. The nodes of the closed form (path.cpp) are 1 / (4 k sqrt(1 + 3u) + 1) apart;
	// where it is of no use rk4's come instead.
	double rate = 0.04 / (settings.tolerance * conditioning(o.h));
	if (u > 1)
		rate *= 41 * u * u * u;
	double inverse = frequency * (1 / 0.55 + std::sqrt(std::sqrt(rate))) + 1;
	if (settings.method == Method::exact)
		inverse = std::max(inverse, 4 * frequency + 1);
	// dopri5 decides on the way: nothing is proven of it but path.cpp's limit. It is seen to take fewer steps than rk4, or
	// than twelve more, for its first is short.
	return 2 + (settings.method == Method::dopri5 ? 12 : 0) +
		   inverse * path.nodes().back().s * (1 + 1e-9); // the nodes' s is a sum of rounded steps
}

// Chords: N grows by the trapezoidal rule, so by no more than its largest density times S; the last chord is a rest, a ramp
// adds five, and those that end because they sweep 1.8 radians no more than one each.
double chord_bound(const Path& path, const Ray& ray) {
	const Orbit& o = path.orbit();
	const double density = o.k * std::sqrt(1.5 * o.h / (8 * 0.4 * ray.settings.tolerance)) * largest_u(path);
	return 2 + (ray.ramp ? 5 : 0) + path.swept() / 1.8 + density * path.nodes().back().s * (1 + 1e-9);
}

// Distance of x from a path's tangent after the angle phi, or at its end, over |x|.
double misses(const Path& path, double phi, const Vec3& x) {
	const Orbit& o = path.orbit();
	const std::vector<Node>& nodes = path.nodes();
	const double s = o.k > 0 ? phi / o.k : 0;
	std::size_t i = 0;
	while (i + 2 < nodes.size() && nodes[i + 1].s < s)
		i++;
	const Node &from = nodes[i], &to = nodes[i + 1];
	const Mark mark{i, s < to.s ? (s - from.s) / (to.s - from.s) : 1};
	const double angle = o.k * (from.s + mark.t * (to.s - from.s));
	const Vec3 there = o.point(path.u_at(mark, Piece(from, to)), std::cos(angle), std::sin(angle));
	return length(cross(path.tangent(mark), there - x)) / length(x);
}

// One ray's check, in the order things become known.
struct Check {
	const Ray& ray;
	Path& path;
	Figures& f;
	const double R = ray.settings.effect_radius, tolerance = ray.settings.tolerance;
	Launch launch{ray.x, ray.d};
	Escape out{};
	bool escapes = false, near = false, lost = false, known = false, fell_back = false;

	Check(const Ray& r, Path& p, Figures& figures) : ray(r), path(p), f(figures) {}
	std::string outcome();
	std::string solution();
	std::string ends();
	std::string chords();
	std::string exit();
	std::string back();
};

std::string Check::outcome() {
	double margin;
	const Outcome right = witness(ray, margin);
	f.rays++;
	if (margin > 0)
		f.closest = std::min(f.closest, margin);
	// Beyond 1e-30 quadruple precision is sure of itself; no pair of doubles is nearer but the exactly critical ones, and
	// those that sit on the photon sphere, which the margin is zero for.
	escapes = classify(ray.x, ray.d) == Outcome::escaped;
	if (escapes != (right == Outcome::escaped) && (margin > 1e-30 || margin == 0))
		return words("classify() says %s, margin %g", escapes ? "escaped" : "captured", margin);
	if ((launch.outcome == Outcome::escaped) != escapes)
		return "Launch's outcome is not classify()'s";
	if (!std::isfinite(launch.r) || !std::isfinite(launch.u) || !std::isfinite(launch.F2) || !std::isfinite(launch.B) ||
		!std::isfinite(launch.kappa) || !finite(launch.axis) || !std::isfinite(launch.across))
		return "Launch is not finite";
	if (escape(ray.x, ray.d, R, out) != escapes)
		return "escape()'s outcome is not classify()'s";
	// On the photon sphere a ray may be outward by as little as the exponent's range has, 1e-632: it sweeps its logarithm.
	if (escapes && !(out.phi >= 0 && out.phi < 1500))
		return words("escape() sweeps %g", out.phi);
	if (escapes && !(std::fabs(length(out.at) - 1) < 1e-14 && std::fabs(length(out.tangent) - 1) < 1e-14))
		return words("escape()'s place and tangent are of length %.17g and %.17g", length(out.at), length(out.tangent));
	return {};
}

std::string Check::solution() {
	if (!path.solve(ray.x, ray.d, ray.settings))
		return words("solve() found no path (nudged %d, %zu nodes)", int(path.nudged()), path.nodes().size());
	if ((path.outcome() == Outcome::escaped) != escapes)
		return "the path's outcome is not classify()'s";
	const Orbit& orbit = path.orbit();
	// Within a hundredth of Rs of the singularity, the energy, 1, is what remains of |v|^2 = 1 + b^2 u^3: nothing is promised
	// where more than eight digits go.
	lost = launch.u > 100 && orbit.h * orbit.h * launch.u * launch.u * launch.u > 1e8;
	near = lost || std::fabs(orbit.h / critical_b - 1) < 1e-3;
	f.captured += !escapes;
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
	const double bound = step_bound(path, ray.settings);
	f.nodes += long(nodes.size());
	f.most_nodes = std::max(f.most_nodes, long(nodes.size()));
	if (nodes.size() > 10) // fewer are the bound's own two
		f.steps = std::max(f.steps, double(nodes.size()) / bound);
	return double(nodes.size()) > bound ? words("%zu nodes, bound %g", nodes.size(), bound) : "";
}

std::string Check::ends() {
	const double swept = path.swept(), drift = path.drift();
	f.swept = std::max(f.swept, swept);
	f.turned += swept > 31.4;
	// path.cpp nudges what sweeps more; a step is no longer than 1.
	if (!(swept >= 0 && swept < 46))
		return words("swept %g", swept);
	if (!std::isfinite(drift))
		return "drift is not finite";
	const Vec3 end = path.end(), tangent = path.end_tangent();
	if (!finite(end) || !(std::fabs(length(tangent) - 1) < 1e-14))
		return words("end %g %g %g, tangent of length %g", end.x, end.y, end.z, length(tangent));
	fell_back = path.started_inside() && path.emerged() == 0 && !escapes;
	if (!fell_back && !(std::fabs(length(end) / (escapes ? R : 1) - 1) < 1e-14))
		return words("ends at radius %.17g", length(end));
	if (path.started_inside() && escapes && !(path.emerged() > 0 || path.nodes()[0].u == 1))
		return "escaped from inside and never emerged";
	if (!path.nudged() && !lost) {
		f.drift = std::max(f.drift, drift / tolerance);
		if (!(drift <= tolerance))
			return words("drift %g", drift);
	}
	return {};
}

// Joined, from the start (or the horizon) to the end.
std::string Check::chords() {
	const Orbit& orbit = path.orbit();
	const std::vector<Node>& nodes = path.nodes();
	const double most = chord_bound(path, ray);
	const Vec3 normal = cross(orbit.e1, orbit.e2);
	std::optional<Exact_Orbit> curve;
	if (known)
		curve.emplace(ray.x, ray.d);
	Chords chords(path, tolerance, ray.ramp);
	Chord c{};
	std::size_t count = 0;
	Vec3 at = orbit.to_space(orbit.p);
	while (chords.next(c)) {
		if (++count > most)
			return words("more chords than %g", most);
		if (!finite(c.from) || !finite(c.to) || !std::isfinite(c.nearest) || !std::isfinite(c.farthest))
			return words("chord %zu is not finite", count);
		// Where it emerges is as exact as the closed form's u: for nearly radial rays its digits less those of 1 / b.
		if (count == 1 && path.started_inside() ? std::fabs(length(c.from) - 1) > 1e-10 && orbit.u != 1
												: length(c.from - at) != 0)
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
		if (!curve || curve->radial())
			continue;
		for (double part : {0.3, 0.5, 1.0}) {
			const Vec3 q = (1 - part) * c.from + part * c.to;
			// The angle swept at the point: that of its end on the path, and what is between them.
			const double back = std::atan2(dot(cross(q, c.to), normal), dot(q, c.to));
			const double off = distance(*curve, orbit.k * s1 - back, length(q)) / tolerance;
			f.off = std::max(f.off, off);
			if (!(off < 1))
				return words("chord %zu of b %.17g is %g of the tolerance off at part %g, radius %.17g", count, orbit.h, off,
					part, length(q));
		}
	}
	f.chords += long(count);
	f.most_chords = std::max(f.most_chords, long(count));
	if (count > 0 && length(at - path.end()) != 0)
		return "the last chord does not end where the path does";
	return count == 0 && !fell_back && !path.started_inside() ? "no chords" : "";
}

// Where it starts on the sphere, along it, a last digit of r is worth its root.
double graze(const Check& c) {
	return c.path.orbit().r >= c.R * (1 - 1e-12) ? 4e-16 / (std::sqrt(c.launch.F2) * c.launch.r + 1e-8) : 0;
}

std::string Check::exit() {
	if (!escapes)
		return {};
	f.oracle++;
	const double direction = length(path.end_tangent() - out.tangent) / tolerance,
				 off = length(path.end() - R * out.at) / (R * tolerance);
	f.direction = std::max(f.direction, direction);
	return direction < 1 && off < 1 + (1e-14 + graze(*this)) / tolerance
			   ? ""
			   : words("exit off by %g of the tolerance in direction, %g in place", direction, off);
}

// Back from the end, on the sphere or the horizon, past where it began. Each way keeps the tolerance by itself.
std::string Check::back() {
	const Orbit& orbit = path.orbit();
	// From the horizon those that come far enough out: what falls back may not come out by as much as the tolerance tells.
	if (path.started_inside() || (!escapes && launch.kappa > 0))
		return {};
	const Vec3 end = path.end();
	Path other;
	if (!other.solve(end, -path.end_tangent(), ray.settings))
		return "no path back";
	if (escapes && orbit.r >= R * (1 - 1e-15) && dot(ray.x, ray.d) < 0 && other.outcome() != Outcome::escaped)
		return "the path back is captured";
	f.back++;
	const double off = misses(other, path.swept(), ray.x) / tolerance;
	// The tangent's last digits are worth 1e-16 of the end's radius of b.
	const double digits = 1e-15 * length(end) / (std::max(orbit.h, 1.0) * std::min(1.0, std::fabs(orbit.h / critical_b - 1)));
	const double allowance = (digits + graze(*this)) / tolerance;
	if (allowance < 0.1)
		f.back_off = std::max(f.back_off, off);
	return off < 2 + allowance ? "" : words("back off by %g of the tolerance", off);
}

} // namespace

std::string check(const Ray& ray, bool exact, Path& path, Figures& figures) {
	Check c(ray, path, figures);
	std::string what = c.outcome();
	if (what.empty())
		what = c.solution();
	if (!what.empty())
		return what;
	what = c.ends();
	c.known = exact && !c.near;
	if (what.empty())
		what = c.chords();
	if (what.empty() && c.known)
		what = c.exit();
	if (what.empty() && c.known)
		what = c.back();
	return what;
}

} // namespace extremes
