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

} // namespace

Chords::Chords(const Path& path, double tolerance, bool ramp)
	: path_(path), scale_(path.orbit().k * std::sqrt(1.5 * path.orbit().h / (8 * share * tolerance))), ramp_(ramp) {
	load(0);
	point_ = path.orbit().to_space(path.orbit().p);
	tangent_ = unit(path.orbit().to_space(path.orbit().v));
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

// Point and tangent where it stands.
void Chords::place() {
	const Node& from = path_.nodes()[i_];
	const Orbit& orbit = path_.orbit();
	const Piece piece(from, path_.nodes()[i_ + 1]);
	const double phi = orbit.k * (from.s + t_ * length_), c = std::cos(phi), s = std::sin(phi), u = piece.at(t_);
	point_ = orbit.point(u, c, s);
	tangent_ = unit(orbit.velocity(u, piece.slope(t_) / length_, c, s));
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
	constexpr int ramp_count = static_cast<int>(std::size(ramp_nodes));
	count_++;
	double target = count_;
	if (ramp_)
		target = count_ <= ramp_count ? ramp_nodes[count_ - 1] : count_ - ramp_count + 1;
	advance(target);
	chord.from = point_;
	chord.tangent_from = tangent_;
	if (ended_) {
		point_ = path_.end();
		tangent_ = path_.end_tangent();
	} else
		place();
	chord.to = point_;
	chord.tangent_to = tangent_;

	const double a = length(chord.from), b = length(chord.to);
	const Vec3 along = chord.to - chord.from;
	const double l2 = dot(along, along);
	const double s = l2 > 0 ? -dot(chord.from, along) / l2 : 0;
	chord.farthest = std::max(a, b);
	chord.nearest = s > 0 && s < 1 ? length(chord.from + s * along) : std::min(a, b);
	return true;
}

} // namespace blackhole
