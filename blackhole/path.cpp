// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/path.h"

#include <algorithm>

namespace blackhole {
namespace {

// A ray that is not within a rounding of b_c needs under a thousand steps at a tolerance of 1e-2 and under
// thirty thousand at 1e-9; one that is winds on, and each turn costs a few hundred more at most.
constexpr std::size_t most_steps = 200000;

// Where on the piece the radius is reached, t in [0, 1]; outward: on the way out. The radius is reached
// exactly once in that sense: steps are shorter than the path takes to turn round. Newton, kept in a bracket.
double crossing(const Piece& piece, double radius, bool outward) {
	double lo = 0, hi = 1, t = 1;
	for (int i = 0; i < 80; i++) {
		const Vec2 p = piece.at(t), d = piece.tangent(t);
		const double f = dot(p, p) - radius * radius, slope = 2 * dot(p, d);
		const bool beyond = outward ? (f > 0 && slope > 0) : f < 0;
		(beyond ? hi : lo) = t;
		// No better than the radius's own rounding.
		if (std::fabs(f) <= 4e-16 * radius * radius)
			break;
		double next = t - f / slope;
		if (!(next > lo && next < hi))
			next = (lo + hi) / 2;
		t = next;
	}
	return t;
}

Node node_at(const Node& from, const Node& to, double t, double h2) {
	const Piece piece(from, to);
	Node n;
	const double dl = to.lambda - from.lambda;
	n.p = piece.at(t);
	n.v = (1 / dl) * piece.tangent(t);
	n.a = acceleration(n.p, h2);
	n.lambda = from.lambda + t * dl;
	return n;
}

} // namespace

// Ends the path on the radius between the node before and this one.
bool Path::finish(const Node& last, double radius, bool outward) {
	const Node before = nodes_.back();
	const double t = crossing(Piece(before, last), radius, outward);
	nodes_.push_back(node_at(before, last, t, orbit_.h * orbit_.h));
	return true;
}

// Steps until the sphere or the horizon. Returns whether the numbers did what classify() says.
bool Path::trace(const Settings& settings) {
	const double h2 = orbit_.h * orbit_.h, R = settings.effect_radius;
	const Integrator& integrator = integrator_of(settings.method);
	const Plan plan = integrator.start(orbit_, settings.tolerance);
	nodes_.clear();
	nodes_.push_back({orbit_.p, orbit_.v, acceleration(orbit_.p, h2), 0});
	half_turns_ = 0;
	emerged_ = 0;
	bool within = inside_;
	while (nodes_.size() < most_steps) {
		const Node next = integrator.step(nodes_.back(), plan);
		const double r2 = dot(next.p, next.p), outward = dot(next.p, next.v);
		if (!(r2 < 1e300))
			return false;
		if (within && outward < 0) {
			// Came out by less than a step, or not at all: nothing that the tolerance could tell from staying in.
			nodes_.push_back(next);
			return outcome_ == Outcome::captured;
		}
		if (within && r2 > 1) {
			const Node before = nodes_.back();
			emerged_ = before.lambda + crossing(Piece(before, next), 1, true) * (next.lambda - before.lambda);
			within = false;
		}
		if (!within && r2 <= 1 && outward < 0)
			return finish(next, 1, false) && outcome_ == Outcome::captured;
		if (r2 >= R * R && outward > 0)
			return finish(next, R, true) && outcome_ == Outcome::escaped;
		// h >= 0, so y changes sign once each half turn.
		const double y = nodes_.back().p.y;
		if ((y >= 0) != (next.p.y >= 0) && nodes_.size() > 1)
			half_turns_++;
		nodes_.push_back(next);
	}
	return false;
}

bool Path::solve(const Vec3& x, const Vec3& d, const Settings& settings) {
	orbit_ = Orbit(x, d);
	outcome_ = classify(x, d);
	inside_ = orbit_.r <= 1;
	nudged_ = false;
	if (trace(settings))
		return true;
	// So close to b_c that the integrator's own error decides: the double's neighbour on the right side is
	// followed instead. Nothing else is promised within 0.1 % of b_c, and no ray is lost.
	const Orbit exact = orbit_;
	const bool wider = outcome_ == Outcome::escaped;
	const bool from_outside = exact.r > photon_sphere;
	for (double nudge = 1e-13; nudge < 2e-3; nudge *= 8) {
		// Outside the photon sphere a larger b escapes; inside it a smaller one does.
		const double s = 1 + (wider == from_outside ? nudge : -nudge);
		const Vec2 v = {exact.v.x, exact.v.y * s};
		orbit_ = Orbit(exact.to_space(exact.p), exact.to_space(v));
		nudged_ = true;
		if (trace(settings))
			return true;
	}
	return false;
}

double Path::length() const {
	double sum = 0;
	for (std::size_t i = 1; i < nodes_.size(); i++)
		sum += blackhole::length(nodes_[i].p - nodes_[i - 1].p);
	return sum;
}

double Path::swept() const {
	const Vec2 p = nodes_.back().p;
	double phi = std::atan2(p.y, p.x);
	const double pi = 3.14159265358979323846;
	// half_turns_ counted whole half turns before the last node; the angle within the last one is known.
	const double low = half_turns_ * pi;
	while (phi < low - 0.5 * pi)
		phi += 2 * pi;
	return std::max(phi, 0.0);
}

double Path::drift() const {
	const Node& n = nodes_.back();
	const double r2 = dot(n.p, n.p);
	const double h = cross(n.p, n.v);
	const double v2 = dot(n.v, n.v), energy = v2 - h * h / (r2 * std::sqrt(r2));
	const double dh = orbit_.h > 0 ? std::fabs(h / orbit_.h - 1) : std::fabs(h);
	return std::max(dh, std::fabs(energy - 1) / std::max(1.0, v2));
}

} // namespace blackhole
