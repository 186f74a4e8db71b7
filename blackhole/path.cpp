// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/path.h"

#include <algorithm>

namespace blackhole {
namespace {

// A ray that is not within a rounding of b_c (1e-16) sweeps less than 41 radians; one that is, or that starts within one of the
// photon sphere, would wind on until rounding decides, or for ever: it is nudged. So rk4 takes at most 2 + 90 (1/0.55 +
// rate^(1/4)) + 45 steps outside the horizon, 41,000 at a tolerance of 1e-9 (its step is at least 1 / (2 k (...) + 1)).
constexpr double most_swept = 45;
// The closed form is for less: within 1e-7 of b_c rays are stepped, whatever the method. And for b above this: u's own error is
// 1e-18 / b there, while all that such a ray bends, b^2, is nothing, and its steps are exact.
constexpr double most_swept_exactly = 18, least_b_exactly = 1e-6;
constexpr std::size_t most_steps = 200000; // no method should come near it
constexpr double no_length = 1e-300;       // in s, of a path that starts where it ends

} // namespace

// Ends the path where u is reached between the node before and this one.
bool Path::finish(const Node& last, double u) {
	const Node before = nodes_.back();
	const Piece piece(before, last);
	const double t = crossing(piece, u), h = last.s - before.s;
	nodes_.push_back({before.s + t * h, u, piece.slope(t) / h, acceleration(u, orbit_.k * orbit_.k)});
	return true;
}

// Steps until the sphere or the horizon. Returns whether the numbers did what classify() says.
bool Path::trace(const Settings& settings) {
	const double edge = 1 / settings.effect_radius;
	const Integrator& integrator = integrator_of(settings.method);
	Plan plan = integrator.start(orbit_, settings.tolerance);
	nodes_.clear();
	nodes_.push_back({0, orbit_.u, orbit_.w, acceleration(orbit_.u, plan.k2)});
	emerged_ = 0;
	if (const Node& first = nodes_.front(); first.u <= edge && first.w <= 0) {
		// Leaves from the sphere itself, where a crossing to be found, if it is tangential, were no better than a last digit's
		// root.
		nodes_.push_back({no_length, edge, first.w, first.a});
		return outcome_ == Outcome::escaped;
	}
	bool within = inside_;
	while (nodes_.size() < most_steps) {
		const Node before = nodes_.back(), next = integrator.step(before, plan);
		if (!(std::fabs(next.u) < 1e300) || before.s * orbit_.k > most_swept)
			return false;
		if (within && next.w > 0) {
			// Came out by less than a step, or not at all: nothing that the tolerance could tell from staying in.
			nodes_.push_back(next);
			return outcome_ == Outcome::captured;
		}
		if (within && next.u < 1) {
			emerged_ = before.s + crossing(Piece(before, next), 1) * (next.s - before.s);
			within = false;
		}
		if (!within && next.u >= 1 && next.w > 0)
			return finish(next, 1) && outcome_ == Outcome::captured;
		if (next.u <= edge && next.w < 0) {
			finish(next, edge);
			// The last piece is not quite the step it was cut from: where it came out in that very step is on the piece.
			if (const Node& last = nodes_.back(); emerged_ > before.s)
				emerged_ = before.s + crossing(Piece(before, last), 1) * (last.s - before.s);
			return outcome_ == Outcome::escaped;
		}
		nodes_.push_back(next);
	}
	exhausted_ = true;
	return false;
}

// The closed form says where the path ends; nodes on the way are laid as densely as the quintic between them is used for,
// which is to place chords, not their ends. It is not for rays that wind on: what a last digit is worth grows as exp(phi).
bool Path::trace_exactly(const Settings& settings) {
	constexpr double apart = 0.25; // in the equation's own time
	const double k = orbit_.k, last = exact_->end(settings.effect_radius) / k;
	if (!(k * last <= most_swept_exactly) || (last == 0 && outcome_ == Outcome::captured && !inside_)) {
		exact_.reset();
		return false;
	}
	const auto node = [&](double s) {
		const Exact_Orbit::State at = exact_->at(k * s);
		return Node{s, at.u, k * at.du, acceleration(at.u, k * k)};
	};
	nodes_.clear();
	nodes_.push_back({0, orbit_.u, orbit_.w, acceleration(orbit_.u, k * k)});
	const bool comes_out = inside_ && last > 0;
	emerged_ = comes_out ? std::max(exact_->swept(1, false) / k, no_length) : 0;
	while (nodes_.size() < most_steps) {
		const Node& n = nodes_.back();
		const double s = n.s + 1 / (k * std::sqrt(1 + 3 * n.u) / apart + 1);
		if (!(s < last))
			break;
		nodes_.push_back(node(s));
	}
	Node end = last > 0 ? node(last) : nodes_.front();
	if (!(last > 0))
		end.s = no_length; // it starts where it ends, or never leaves the horizon
	if (outcome_ == Outcome::escaped || last > 0)
		end.u = outcome_ == Outcome::escaped ? 1 / settings.effect_radius : 1;
	nodes_.push_back(end);
	return true;
}

bool Path::solve(const Vec3& x, const Vec3& d, const Settings& settings) {
	orbit_ = Orbit(x, d);
	inside_ = orbit_.r <= 1;
	nudged_ = exhausted_ = false;
	exact_.reset();
	if (settings.method == Method::exact) {
		exact_.emplace(x, d);
		outcome_ = exact_->outcome();
		if (orbit_.h > least_b_exactly && !exact_->critical() && trace_exactly(settings))
			return true;
		exact_.reset();
	} else
		outcome_ = classify(x, d);
	if (trace(settings))
		return true;
	// So close to b_c that the integrator's own error decides: the double's neighbour on the right side is
	// followed instead. Nothing else is promised within 0.1 % of b_c, and no ray is lost.
	const Orbit exact = orbit_;
	const double side = outcome_ == Outcome::escaped ? 1 : -1;
	for (double nudge = 1e-13; nudge < 2e-3 && !exhausted_; nudge *= 8) {
		// Turned outward a ray escapes, on either side of the photon sphere and for a tangential one too. By this angle b changes
		// by about the share nudge of it, wherever the ray starts.
		const double angle = side * nudge * exact.v.y / blackhole::length(exact.v);
		const Vec2 v = {exact.v.x + angle * exact.v.y, exact.v.y - angle * exact.v.x};
		orbit_ = Orbit(exact.to_space(exact.p), exact.to_space(v));
		nudged_ = true;
		if (trace(settings))
			return true;
	}
	return false;
}

Vec3 Path::tangent(const Mark& mark) const {
	const Node &from = nodes_[mark.piece], &to = nodes_[mark.piece + 1];
	const Piece piece(from, to);
	const double h = to.s - from.s, phi = orbit_.k * (from.s + mark.t * h);
	// A path that starts where it ends has a piece of no length.
	double u = piece.at(mark.t), w = h > 0 ? piece.slope(mark.t) / h : to.w;
	if (exact_) {
		const Exact_Orbit::State at = exact_->at(phi);
		u = at.u;
		w = orbit_.k * at.du;
	}
	return unit(orbit_.velocity(u, w, std::cos(phi), std::sin(phi)));
}

double Path::length() const {
	double sum = 0;
	const double k = orbit_.k;
	Vec2 from = orbit_.p;
	for (std::size_t i = 1; i < nodes_.size(); i++) {
		const Node &a = nodes_[i - 1], &b = nodes_[i];
		// Steps are long where the path is nearly straight, but sweep half a radian: with a point between, 1e-3 is left.
		const double s = 0.5 * (a.s + b.s), u = Piece(a, b).at(0.5);
		const Vec2 middle = {std::cos(k * s) / u, std::sin(k * s) / u}, to = {std::cos(k * b.s) / b.u, std::sin(k * b.s) / b.u};
		sum += blackhole::length(middle - from) + blackhole::length(to - middle);
		from = to;
	}
	return sum;
}

double Path::drift() const {
	const Node& n = nodes_.back();
	const double b = orbit_.h, beta = std::max(b, 1.0);
	const double v2 = 1 + b * b * n.u * n.u * n.u, energy = beta * beta * n.w * n.w + b * b * n.u * n.u * (1 - n.u);
	return std::fabs(energy - 1) / v2;
}

} // namespace blackhole
