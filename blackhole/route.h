// SPDX-License-Identifier: AGPL-3.0-or-later
/// One ray's way by the atlas: the same as a Path with its Chords, for a fraction of the time, where the atlas has it.
///
/// Chords end at the orbit's charted knots, wherever the ray starts: the first and the last are shorter. As the start moves
/// across a knot a chord of no length comes or goes, so nothing tears.
#ifndef BLACKHOLE_ROUTE_H
#define BLACKHOLE_ROUTE_H

#include "blackhole/atlas.h"
#include "blackhole/chords.h"

namespace blackhole {

/// Four pieces of a way in the orbit's plane, each of some chords in a row, in single precision, rounded outward.
struct Pieces {
	Four x, y;              ///< where they begin, by the plane's axes
	Four dx, dy;            ///< from there to where they end: the long chord
	Four bulge;             ///< no point of the piece is farther from the long chord
	Four nearest, farthest; ///< to the centre, as a chord's
	Four length;            ///< of the piece, as of a cubic
};

class Route {
public:
	/// x, d as for Path::solve(), outside the horizon; ramp as for Chords. Returns false where the atlas does not have the ray:
	/// then a Path must do. A walk begins at the start.
	bool solve(const Vec3& x, const Vec3& d, const Atlas& atlas, bool ramp);

	Outcome outcome() const { return escapes_ ? Outcome::escaped : Outcome::captured; }
	/// Where it ends and the unit tangent there, as Path's.
	Vec3 end() const { return place(end_, 1 / end_.u); }
	Vec3 end_tangent() const { return direction(end_); }
	/// Angle swept around the hole's centre, radians.
	double swept() const { return swept_; }
	/// The energy's relative change to the first knot, as Path's.
	double drift() const;
	/// Euclidean length, as all its chords.
	double length() const;

	/// As those of Chords. A mark's piece is the corner's number from the start.
	bool next(Chord& chord);
	bool next(Arc& arc, int chords);
	using Bookmark = int;
	Bookmark bookmark() const { return at_; }
	void go_to(Bookmark there);
	Vec3 tangent(const Mark& mark) const;

	/// How many chords there are.
	int chords() const { return corners_; }
	/// The next four pieces of so many chords from the first on, but none beyond the last; how many there are.
	int pieces(int first, int last, int chords, Pieces& out) const;
	/// The orbit's plane: unit vectors at right angles.
	const Vec3& e1() const { return f1_; }
	const Vec3& e2() const { return f2_; }

private:
	// u, du/ds along the ray, and the angle from where the orbit's knots are counted.
	struct State {
		double u, w, cosine, sine;
	};
	static State even(const State& of);
	State turned(const State& from, double u, double w, double s) const;
	State canonical(int q) const;
	State corner(int number) const;
	Vec3 place(const State& at, double r) const;
	Vec3 direction(const State& at) const;
	double slope(const State& at, Vec2 along) const;
	void add_ramp(double edge);
	Knot row(int number) const;

	Charted orbit_;
	Vec3 start_, f1_, f2_; // axes of the orbit's plane, the angle counted from f1
	double tolerance_ = 0, swept_ = 0, per_size_ = 1;
	int most_in_arc_ = 1;
	bool escapes_ = true;
	State begin_{}, end_{};
	State ramp_[ramp_count];
	int ramps_ = 0;
	int first_ = 0, last_ = -1; // knots on the way: canonical(first_) ... canonical(last_)
	int corners_ = 1;           // after the start
	// The walk.
	int at_ = 0;
	State state_{};
	Vec3 point_;
	double r_ = 1;
};

} // namespace blackhole

#endif
