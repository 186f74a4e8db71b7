// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/chords.h"

#include "blackhole/turn.h"

#include <algorithm>

namespace blackhole {
namespace {

// The rule takes the curvature to be that of all of a chord. Where one chord would take a ray past the hole and far out again,
// all of the bend is in its middle: it strays by r_far / b there, which may be hundreds of tolerance * b. So no chord sweeps more
// than about a right angle, unless the bend is nothing at any radius: slack, in b^2 tolerance / r_far. What the method does wrong
// at the far end, half of tolerance * r_far at most, is half as much in the middle, where b is what counts: so none goes past the
// hole to more than about 2.6 b (where 2 acos(b / r_far) = 1.8 + 1.5 b / r_far).
constexpr double widest = 1.8, slack = 0.35, slack_far = 1.5;
// The most that an arc of several chords may sweep.
constexpr double widest_arc = 0.7;

} // namespace

Chords::Chords(const Path& path, double tolerance, bool ramp)
	: path_(&path), tolerance_(tolerance),
	  scale_(path.orbit().k * std::sqrt(1.5 * path.orbit().h / (8 * chord_share * tolerance))), ramp_(ramp) {
	const double far = std::max(path.orbit().r, 1 / path.nodes().back().u), b = path.orbit().h;
	widest_ = widest + std::min(slack * tolerance * b * b / far, slack_far * b / far);
	load(0);
	look();
	place_ = path.orbit().p;
	point_ = path.orbit().to_space(place_);
	r_ = path.orbit().r;
	if (path.started_inside() && path.emerged() == 0)
		ended_ = true;
	if (path.started_inside() && path.emerged() > 0) {
		const std::vector<Node>& nodes = path.nodes();
		while (i_ + 2 < nodes.size() && nodes[i_ + 1].s < path.emerged())
			load(i_ + 1);
		t_ = (path.emerged() - nodes[i_].s) / (nodes[i_ + 1].s - nodes[i_].s);
		piece_n_ = -(d0_ + 0.5 * (d1_ - d0_) * t_) * t_ * length_;
		place();
	}
}

// dN/ds at a node.
double Chords::density(std::size_t node) const {
	const double u = path_->nodes()[node].u, b = path_->orbit().h;
	return scale_ * u / std::sqrt(std::sqrt(1 + b * b * u * u * u));
}

void Chords::load(std::size_t i) {
	if (i > 0)
		piece_n_ += 0.5 * (d0_ + d1_) * length_;
	i_ = i;
	t_ = 0;
	const std::vector<Node>& nodes = path_->nodes();
	d0_ = i == 0 ? density(0) : d1_;
	d1_ = density(i + 1);
	length_ = nodes[i + 1].s - nodes[i].s;
}

// Many pieces are only passed through: what it takes to place points on one is made when the first is.
void Chords::look() {
	if (looked_ == i_)
		return;
	looked_ = i_;
	const Node &from = path_->nodes()[i_], &to = path_->nodes()[i_ + 1];
	curve_ = Piece(from, to);
	cosine_ = std::cos(path_->orbit().k * from.s);
	sine_ = std::sin(path_->orbit().k * from.s);
}

// The point where it stands.
void Chords::place() {
	look();
	const Orbit& orbit = path_->orbit();
	const double u = path_->u_at({i_, t_}, curve_);
	const double since = orbit.k * t_ * length_;
	double c, s;
	turn(since, c, s);
	phi_ = orbit.k * path_->nodes()[i_].s + since;
	r_ = 1 / u;
	place_ = {r_ * (c * cosine_ - s * sine_), r_ * (s * cosine_ + c * sine_)};
	point_ = orbit.to_space(place_);
}

void Chords::place_end() {
	look();
	r_ = 1 / path_->nodes().back().u;
	phi_ = path_->swept();
	place_ = {r_ * std::cos(phi_), r_ * std::sin(phi_)};
	point_ = path_->end();
}

// In the plane, where it stands; of the length that unit energy gives it.
Vec2 Chords::velocity() const {
	const double b = path_->orbit().h, out = -std::max(b, 1.0) * curve_.slope(t_) / length_, across = b / r_;
	const double c = place_.x / r_, s = place_.y / r_;
	return {out * c - across * s, out * s + across * c};
}

// N at the end of so many chords.
double Chords::target(int count) const {
	if (!ramp_)
		return count;
	return count <= ramp_count ? ramp_corners[count - 1] : count - ramp_count + 1;
}

// Moves to where N reaches target or phi most, or to the end. Whether phi ended it: then N counts on from there.
bool Chords::advance(double target, double most) {
	const double k = path_->orbit().k;
	while (piece_n_ + 0.5 * (d0_ + d1_) * length_ <= target && k * path_->nodes()[i_ + 1].s <= most) {
		if (i_ + 2 >= path_->nodes().size()) {
			t_ = 1;
			ended_ = true;
			return false;
		}
		load(i_ + 1);
	}
	// d0 t + (d1 - d0) t^2 / 2 = c, solved without cancellation.
	const double c = (target - piece_n_) / length_;
	if (!(c >= 0)) { // not a number: no chord is better than chords without end
		t_ = 1;
		ended_ = true;
		return false;
	}
	const double t = 2 * c / (d0_ + std::sqrt(std::max(0.0, d0_ * d0_ + 2 * (d1_ - d0_) * c)));
	const double wide = k * length_ > 0 ? (most / k - path_->nodes()[i_].s) / length_ : 2;
	if (wide < t) {
		t_ = std::clamp(wide, 0.0, 1.0);
		n_ = piece_n_ + (d0_ + 0.5 * (d1_ - d0_) * t_) * t_ * length_;
		count_ = ramp_ ? ramp_count - 1 : 0;
		return true;
	}
	t_ = std::clamp(t, 0.0, 1.0);
	return false;
}

bool Chords::next(Chord& chord) {
	if (ended_)
		return false;
	const double r = r_, phi = phi_;
	chord.from = point_;
	chord.at_from = {i_, t_};
	count_++;
	advance(n_ + target(count_), phi + widest_);
	if (ended_)
		place_end();
	else
		place();
	chord.to = point_;
	chord.at_to = {i_, t_};

	// The foot of the perpendicular on a chord between equal radii is at their cosine of half the angle; no chord comes nearer.
	const double half = 0.5 * (phi_ - phi);
	chord.farthest = std::max(r, r_);
	chord.nearest = std::min(r, r_) * std::max(0.0, 1 - 0.5 * half * half);
	return true;
}

bool Chords::next(Arc& arc, int chords) {
	if (ended_)
		return false;
	const double r = r_, phi = phi_;
	const Vec2 from = place_, v = velocity();
	arc.from = point_;
	arc.chords = chords;
	// An arc that sweeps much is a poor triangle: then one chord is better. There are few of them.
	if (path_->swept() > phi + widest_arc && chords > 1) {
		const std::size_t i = i_;
		const double t = t_, n = n_, piece_n = piece_n_, d0 = d0_, d1 = d1_, l = length_;
		const int count = count_;
		count_ += chords;
		if (advance(n_ + target(count_), phi + widest_arc)) {
			i_ = i;
			t_ = t;
			n_ = n;
			piece_n_ = piece_n;
			d0_ = d0;
			d1_ = d1;
			length_ = l;
			count_ = count + 1;
			arc.chords = 1;
			advance(n_ + target(count_), phi + widest_);
		}
	} else {
		count_ += chords;
		advance(n_ + target(count_), phi + widest_);
	}
	if (ended_) {
		// The last chord is the first whose end the path does not reach.
		const double last = piece_n_ + 0.5 * (d0_ + d1_) * length_ - n_;
		int first = count_ - arc.chords + 1;
		for (arc.chords = 1; first < count_ && target(first) < last; first++)
			arc.chords++;
		place_end();
	} else
		place();
	arc.to = point_;

	// The triangle of a path's chord and its end tangents, all to one side of it: how steep they are, and its height.
	const Vec2 u = velocity(), along = place_ - from;
	const double l = length(along), steep = 100;
	const auto slope = [&](Vec2 t) {
		return std::fabs(cross(t, along)) < steep * dot(t, along) ? std::fabs(cross(t, along)) / dot(t, along) : steep;
	};
	const double p = slope(v), q = slope(u);
	// A little for what the method does wrong.
	arc.bulge = (p + q > 0 ? l * p * q / (p + q) : 0) + (1e-6 + 2e-3 * tolerance_) * l;
	// Of the cubic with these slopes at its ends.
	arc.length = l * (1 + (2 * p * p + 2 * q * q + p * q) / 30);
	const double half = 0.5 * (phi_ - phi);
	arc.farthest = std::max(r, r_) + arc.bulge; // inside the photon sphere a path turns back on an arc
	arc.nearest = std::min(r, r_) * std::max(0.0, 1 - 0.5 * half * half);
	return true;
}

} // namespace blackhole
