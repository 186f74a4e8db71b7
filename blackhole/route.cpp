// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/route.h"

#include "blackhole/turn.h"

#include <algorithm>
#include <cstdlib>

namespace blackhole {

// Of length 1 to the last digit: the plane's axes are made of the first such, and all of the way's ends should be where its
// pieces' are.
Route::State Route::even(const State& of) {
	const double per = 1 / std::sqrt(of.cosine * of.cosine + of.sine * of.sine);
	return {of.u, of.w, per * of.cosine, per * of.sine};
}

// A way s on from a state, where u and w are known.
Route::State Route::turned(const State& from, double u, double w, double s) const {
	double c, t;
	turn(orbit_.k() * s, c, t);
	return {u, w, c * from.cosine - t * from.sine, t * from.cosine + c * from.sine};
}

// Knot |q|; before the turning point, or on the way in, where q < 0.
[[gnu::always_inline]] inline Route::State Route::canonical(int q) const {
	const Knot n = orbit_.knot(q < 0 ? -q : q);
	const double w = n[1] * per_size_, c = n[2], t = n[3];
	// The interpolated cosine and sine are not quite those of one angle: one step of Newton's towards length 1.
	const double even = 1.5 - 0.5 * (c * c + t * t);
	return q < 0 ? State{n[0], -w, even * c, -even * t} : State{n[0], w, even * c, even * t};
}

[[gnu::always_inline]] inline Route::State Route::corner(int number) const {
	if (number > ramps_ && number < corners_)
		return canonical(first_ + number - ramps_ - 1);
	return number == 0 ? begin_ : (number == corners_ ? end_ : ramp_[number - 1]);
}

Vec3 Route::place(const State& at, double r) const { return (r * at.cosine) * f1_ + (r * at.sine) * f2_; }

Vec3 Route::direction(const State& at) const {
	const double out = -std::max(orbit_.b(), 1.0) * at.w, across = orbit_.b() * at.u;
	return unit((out * at.cosine - across * at.sine) * f1_ + (out * at.sine + across * at.cosine) * f2_);
}

bool Route::solve(const Vec3& x, const Vec3& d, const Atlas& atlas, bool ramp) {
	const Vec3 axis = cross(x, d);
	const double r2 = dot(x, x), twist2 = dot(axis, axis), s = dot(x, d), r = std::sqrt(r2);
	if (!(r > 1 + 1e-6) || !atlas.tells(s, twist2))
		return false;
	// |x|^2 |d|^2 times the energy's square, without cancellation near the horizon.
	const double energy = s * s + twist2 * ((r - 1) / r), twist = std::sqrt(twist2), speed = 1 / std::sqrt(energy);
	const double b = r * twist * speed;
	if (!atlas.find(b, orbit_) || (orbit_.turns() && r <= photon_sphere))
		return false;
	if (tolerance_ != atlas.settings().tolerance) {
		tolerance_ = atlas.settings().tolerance;
		// Of more chords an arc would be a poor triangle.
		most_in_arc_ = std::max(1, static_cast<int>(0.3 / std::sqrt(tolerance_)));
	}
	per_size_ = 1 / std::max(b, 1.0);
	start_ = x;
	const double u = 1 / r, w = -s * speed / std::max(b, 1.0), edge = 1 / atlas.settings().effect_radius;
	escapes_ = orbit_.turns() || s > 0;

	const int knot = orbit_.before(u), in = w > 0 ? -1 : 1;
	// In where it goes out: by symmetry.
	const bool through = orbit_.turns() && w > 0 && std::fabs(u - edge) < 1e-12 * edge;
	if (through) {
		const double angle = orbit_.to_rim(-s * speed);
		swept_ = 2 * angle;
		end_ = {edge, -w, 0, 0};
		turn_far(angle, end_.cosine, end_.sine);
		begin_ = {u, w, end_.cosine, -end_.sine};
	} else {
		// Out from the knot before it, or in to that.
		const double way = orbit_.way(knot, u, -std::fabs(w));
		const State outward = even(turned(canonical(knot), u, -std::fabs(w), way));
		begin_ = {u, w, outward.cosine, in * outward.sine};
		swept_ = -in * (orbit_.angle(knot) + orbit_.k() * way);
	}
	first_ = w > 0 ? -knot : knot + 1;
	const Vec3 e1 = u * x, e2 = (1 / (twist * r)) * cross(axis, x);
	f1_ = begin_.cosine * e1 - begin_.sine * e2;
	f2_ = begin_.sine * e1 + begin_.cosine * e2;

	ramps_ = 0;
	if (ramp)
		add_ramp(escapes_ ? edge : -1);
	if (through)
		last_ = knot;
	else if (escapes_) {
		const double slope = orbit_.slope(edge);
		last_ = orbit_.before(edge);
		const double way = orbit_.way(last_, edge, slope);
		end_ = even(turned(canonical(last_), edge, slope, way));
		swept_ += orbit_.angle(last_) + orbit_.k() * way;
	} else {
		last_ = -1;
		end_ = {1, -orbit_.slope(1), 1, 0};
	}
	corners_ = 1 + ramps_ + std::max(0, last_ - first_ + 1);
	at_ = 0;
	state_ = begin_;
	point_ = x;
	r_ = r;
	return true;
}

// Short steps from the start, each by Runge and Kutta's method in two halves (far out the longest is 0.4 radians: 1e-4 off in
// one), up to a chord's length; the charted knots go on from there.
void Route::add_ramp(double edge) {
	const double k2 = orbit_.k() * orbit_.k(), unit_s = 1 / orbit_.density(begin_.u);
	const auto step = [k2](double& u, double& w, double h) {
		const double half = 0.5 * h, a1 = acceleration(u, k2), a2 = acceleration(u + half * w, k2);
		const double a3 = acceleration(u + half * (w + half * a1), k2), a4 = acceleration(u + h * (w + half * a2), k2);
		u += h * (w + h / 6 * (a1 + a2 + a3));
		w += h / 6 * (a1 + 2 * (a2 + a3) + a4);
	};
	State from = begin_;
	double s = 0;
	for (int i = 0; i < ramp_count; i++) {
		const double h = ramp_corners[i] * unit_s - s;
		double u = from.u, w = from.w;
		step(u, w, 0.5 * h);
		step(u, w, 0.5 * h);
		if (u >= 1 || (u <= edge && w < 0))
			break;
		s += h;
		from = ramp_[ramps_++] = turned(from, u, w, h);
	}
	const int knot = orbit_.before(from.u);
	first_ = from.w > 0 ? -knot : knot + 1;
}

double Route::drift() const {
	const Knot n = orbit_.knot(std::min(std::abs(first_), orbit_.count() - 1));
	const double b = orbit_.b(), u = n[0], v = n[1];
	return std::fabs(v * v + b * b * u * u * (1 - u) - 1) / (1 + b * b * std::fabs(u * u * u));
}

double Route::length() const {
	double sum = 0;
	Vec3 from = start_;
	for (int i = 1; i <= corners_; i++) {
		const State at = corner(i);
		const Vec3 to = place(at, 1 / at.u);
		sum += blackhole::length(to - from);
		from = to;
	}
	return sum;
}

Vec3 Route::tangent(const Mark& mark) const { return direction(corner(static_cast<int>(mark.piece))); }

void Route::go_to(Bookmark there) {
	at_ = there;
	state_ = corner(there);
	r_ = 1 / state_.u;
	point_ = there == 0 ? start_ : place(state_, r_);
}

bool Route::next(Chord& chord) {
	if (at_ >= corners_)
		return false;
	chord.from = point_;
	chord.at_from = {static_cast<std::size_t>(at_), 0};
	const State from = state_;
	const double r = r_;
	state_ = corner(++at_);
	r_ = 1 / state_.u;
	chord.to = point_ = place(state_, r_);
	chord.at_to = {static_cast<std::size_t>(at_), 0};
	// No point of a chord is nearer than the smaller end times the cosine of half the angle; that cosine's square is less.
	const double swept = from.cosine * state_.cosine + from.sine * state_.sine;
	chord.farthest = std::max(r, r_);
	chord.nearest = 0.5 * (1 + swept) * std::min(r, r_);
	return true;
}

// The tangent's off a direction in the plane, as a slope.
double Route::slope(const State& at, Vec2 along) const {
	constexpr double steep = 100;
	const double out = -std::max(orbit_.b(), 1.0) * at.w, across = orbit_.b() * at.u;
	const Vec2 t = {out * at.cosine - across * at.sine, out * at.sine + across * at.cosine};
	const double aside = std::fabs(cross(t, along)), ahead = dot(t, along);
	return aside < steep * ahead ? aside / ahead : steep;
}

bool Route::next(Arc& arc, int chords) {
	if (at_ >= corners_)
		return false;
	arc.from = point_;
	arc.chords = std::min({chords, most_in_arc_, corners_ - at_});
	const State from = state_;
	const double r = r_;
	at_ += arc.chords;
	state_ = corner(at_);
	r_ = 1 / state_.u;
	arc.to = point_ = place(state_, r_);
	const double swept = from.cosine * state_.cosine + from.sine * state_.sine, far = std::max(r, r_);
	// In the plane, the triangle of the long chord and the tangents at its ends: how steep they are, and its height.
	const Vec2 along = {r_ * state_.cosine - r * from.cosine, r_ * state_.sine - r * from.sine};
	const double p = slope(from, along), q = slope(state_, along), l = blackhole::length(along);
	arc.bulge = (p + q > 0 ? l * p * q / (p + q) : 0) + 0.1 * tolerance_ * far;
	arc.length = l * (1 + (2 * p * p + 2 * q * q + p * q) / 30);
	arc.farthest = far + arc.bulge;
	// More than half a turn may come as near as it likes.
	const bool whole = swept < 0 && from.cosine * state_.sine < from.sine * state_.cosine;
	arc.nearest = whole ? 0 : 0.5 * (1 + swept) * std::min(r, r_);
	return true;
}

} // namespace blackhole
