// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/chords.h"

#include <algorithm>
#include <iterator>

namespace blackhole {
namespace {

// Chords get half of the tolerance (the integrator keeps well inside the other half), less a margin for
// curvature that is not constant along a chord.
constexpr double share = 0.5 / 1.25;

// The rule takes the curvature to be that of all of a chord. Where one chord would take a ray past the hole and far out again,
// all of the bend is in its middle: it strays by r_far / b there, which may be hundreds of tolerance * b. So no chord sweeps more
// than about a right angle, unless the bend is nothing at any radius: slack, in b^2 tolerance / r_far. (And what is a hair of the
// tolerance at the far end is much of b, beyond ten of b: no slack there.)
constexpr double widest = 1.8, slack = 0.35;

// A ramp's first nodes, in N.
constexpr double ramp_nodes[] = {1.0 / 128, 1.0 / 32, 1.0 / 8, 1.0 / 2, 1};
constexpr int ramp_count = static_cast<int>(std::size(ramp_nodes));

} // namespace

Chords::Chords(const Path& path, double tolerance, bool ramp)
	: path_(path), scale_(path.orbit().k * std::sqrt(1.5 * path.orbit().h / (8 * share * tolerance))), ramp_(ramp) {
	const double far = std::max(path.orbit().r, 1 / path.nodes().back().u), b = path.orbit().h;
	widest_ = widest + std::min(slack * tolerance * b * b / far, 12 * b / far);
	load(0);
	point_ = path.orbit().to_space(path.orbit().p);
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
	const double u = path_.nodes()[node].u, b = path_.orbit().h;
	return scale_ * u / std::sqrt(std::sqrt(1 + b * b * u * u * u));
}

void Chords::load(std::size_t i) {
	if (i > 0)
		piece_n_ += 0.5 * (d0_ + d1_) * length_;
	i_ = i;
	t_ = 0;
	const std::vector<Node>& nodes = path_.nodes();
	d0_ = i == 0 ? density(0) : d1_;
	d1_ = density(i + 1);
	length_ = nodes[i + 1].s - nodes[i].s;
	curve_ = Piece(nodes[i], nodes[i + 1]);
}

// The point where it stands.
void Chords::place() {
	const Orbit& orbit = path_.orbit();
	const double u = curve_.at(t_);
	phi_ = orbit.k * (path_.nodes()[i_].s + t_ * length_);
	r_ = 1 / u;
	point_ = orbit.point(u, std::cos(phi_), std::sin(phi_));
}

// Moves to where N reaches target or phi most, or to the end.
void Chords::advance(double target, double most) {
	const double k = path_.orbit().k;
	while (piece_n_ + 0.5 * (d0_ + d1_) * length_ <= target && k * path_.nodes()[i_ + 1].s <= most) {
		if (i_ + 2 >= path_.nodes().size()) {
			t_ = 1;
			ended_ = true;
			return;
		}
		load(i_ + 1);
	}
	// d0 t + (d1 - d0) t^2 / 2 = c, solved without cancellation.
	const double c = (target - piece_n_) / length_;
	if (!(c >= 0)) { // not a number: no chord is better than chords without end
		t_ = 1;
		ended_ = true;
		return;
	}
	const double t = 2 * c / (d0_ + std::sqrt(std::max(0.0, d0_ * d0_ + 2 * (d1_ - d0_) * c)));
	const double wide = k * length_ > 0 ? (most / k - path_.nodes()[i_].s) / length_ : 2;
	if (wide < t) { // N counts on from here
		t_ = std::clamp(wide, 0.0, 1.0);
		n_ = piece_n_ + (d0_ + 0.5 * (d1_ - d0_) * t_) * t_ * length_;
		count_ = ramp_ ? ramp_count - 1 : 0;
	} else
		t_ = std::clamp(t, 0.0, 1.0);
}

bool Chords::next(Chord& chord) {
	if (ended_)
		return false;
	count_++;
	double target = count_;
	if (ramp_)
		target = count_ <= ramp_count ? ramp_nodes[count_ - 1] : count_ - ramp_count + 1;
	const double r = r_, phi = phi_;
	chord.from = point_;
	chord.at_from = {i_, t_};
	advance(n_ + target, phi + widest_);
	if (ended_) {
		point_ = path_.end();
		r_ = 1 / path_.nodes().back().u;
		phi_ = path_.swept();
	} else
		place();
	chord.to = point_;
	chord.at_to = {i_, t_};

	// The foot of the perpendicular on a chord between equal radii is at their cosine of half the angle; no chord comes nearer.
	const double half = 0.5 * (phi_ - phi);
	chord.farthest = std::max(r, r_);
	chord.nearest = std::min(r, r_) * std::max(0.0, 1 - 0.5 * half * half);
	return true;
}

} // namespace blackhole
