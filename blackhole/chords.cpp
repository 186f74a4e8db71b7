// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/chords.h"

#include <algorithm>
#include <iterator>

namespace blackhole {
namespace {

// Chords get half of the tolerance (the integrator keeps well inside the other half), less a margin for
// curvature that is not constant along a chord.
constexpr double share = 0.5 / 1.25;

// A ramp's first nodes, in N.
constexpr double ramp_nodes[] = {1.0 / 128, 1.0 / 32, 1.0 / 8, 1.0 / 2, 1};

// Cosine and sine of a step's angle, at most 0.9, to the last digits: the series, for a fifth of what the general ones cost.
void turn(double a, double& cosine, double& sine) {
	const double q = a * a;
	sine =
		a *
		(1 + q * (-1.0 / 6 + q * (1.0 / 120 + q * (-1.0 / 5040 +
													  q * (1.0 / 362880 + q * (-1.0 / 39916800 +
																				  q * (1.0 / 6227020800 - q / 1307674368e3)))))));
	cosine =
		1 + q * (-0.5 + q * (1.0 / 24 + q * (-1.0 / 720 +
												q * (1.0 / 40320 + q * (-1.0 / 3628800 + q * (1.0 / 479001600 +
																								 q * (-1.0 / 87178291200 +
																										 q / 20922789888e3)))))));
}

} // namespace

Chords::Chords(const Path& path, double tolerance, bool ramp)
	: path_(path), scale_(path.orbit().k * std::sqrt(1.5 * path.orbit().h / (8 * share * tolerance))), ramp_(ramp) {
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
}

// Many pieces are only passed through: what it takes to place points on one is made when the first is.
void Chords::look() {
	if (looked_ == i_)
		return;
	looked_ = i_;
	const Node &from = path_.nodes()[i_], &to = path_.nodes()[i_ + 1];
	curve_ = Piece(from, to);
	cosine_ = std::cos(path_.orbit().k * from.s);
	sine_ = std::sin(path_.orbit().k * from.s);
}

// The point where it stands.
void Chords::place() {
	look();
	const Orbit& orbit = path_.orbit();
	const double u = path_.u_at({i_, t_}, curve_);
	const double since = orbit.k * t_ * length_;
	double c, s;
	turn(since, c, s);
	phi_ = orbit.k * path_.nodes()[i_].s + since;
	r_ = 1 / u;
	place_ = {r_ * (c * cosine_ - s * sine_), r_ * (s * cosine_ + c * sine_)};
	point_ = orbit.to_space(place_);
}

void Chords::place_end() {
	look();
	r_ = 1 / path_.nodes().back().u;
	phi_ = path_.swept();
	place_ = {r_ * std::cos(phi_), r_ * std::sin(phi_)};
	point_ = path_.end();
}

// In the plane, where it stands; of the length that unit energy gives it.
Vec2 Chords::velocity() const {
	const double b = path_.orbit().h, out = -std::max(b, 1.0) * curve_.slope(t_) / length_, across = b / r_;
	const double c = place_.x / r_, s = place_.y / r_;
	return {out * c - across * s, out * s + across * c};
}

// N at the end of so many chords.
double Chords::target(int count) const {
	constexpr int ramp_count = static_cast<int>(std::size(ramp_nodes));
	if (!ramp_)
		return count;
	return count <= ramp_count ? ramp_nodes[count - 1] : count - ramp_count + 1;
}

// Moves to where N reaches target, or to the end.
void Chords::advance(double target) {
	while (piece_n_ + 0.5 * (d0_ + d1_) * length_ <= target) {
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
	t_ = std::clamp(2 * c / (d0_ + std::sqrt(std::max(0.0, d0_ * d0_ + 2 * (d1_ - d0_) * c))), 0.0, 1.0);
}

bool Chords::next(Chord& chord) {
	if (ended_)
		return false;
	const double r = r_, phi = phi_;
	chord.from = point_;
	chord.at_from = {i_, t_};
	advance(target(++count_));
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
	const double r = r_, phi = phi_, n = count_ > 0 ? target(count_) : 0;
	const Vec2 from = place_, v = velocity();
	arc.from = point_;
	count_ += chords;
	advance(target(count_));
	if (ended_)
		place_end();
	else
		place();
	arc.to = point_;
	arc.chords = ended_ ? std::min(chords, 1 + static_cast<int>(piece_n_ + 0.5 * (d0_ + d1_) * length_ - n)) : chords;

	const Vec2 to = place_, u = velocity(), along = to - from;
	const double across = cross(v, u);
	// Where it is as good as straight, the middle will do.
	const double a =
		std::fabs(across) > 1e-9 * length(v) * length(u) ? cross(along, u) / across : 0.5 * length(along) / length(v);
	const Vec2 apex = from + a * v;
	arc.apex = path_.orbit().to_space(apex);
	// Between the chord and the two tangents, as of a circle's arc.
	arc.length = (2 * length(along) + length(apex - from) + length(to - apex)) / 3;
	const double half = 0.5 * (phi_ - phi);
	arc.farthest = std::max(r, r_);
	arc.nearest = std::min(r, r_) * std::max(0.0, 1 - 0.5 * half * half);
	return true;
}

} // namespace blackhole
