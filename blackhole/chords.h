// SPDX-License-Identifier: AGPL-3.0-or-later
/// A path as straight chords, as few as the tolerance allows.
///
/// A chord over a length l of curvature c strays from the path by c l^2 / 8. Nodes are laid at equal steps of
/// N = integral of sqrt(c / (8 t r)) dl, with t the share of the tolerance that is the chords': a smooth
/// function of the path, so neighbouring rays get neighbouring chords. With c = (3/2) b^3 u^5 / |v|^3 and
/// dl = |v| / (b u^2) dphi that is dN/dphi = sqrt((3/2) b / (8 t)) u (1 + b^2 u^3)^(-1/4).
#ifndef BLACKHOLE_CHORDS_H
#define BLACKHOLE_CHORDS_H

#include "blackhole/path.h"

namespace blackhole {

/// Chords get half of the tolerance (the method keeps well inside the other half), less a margin for curvature that is not
/// constant along a chord.
constexpr double chord_share = 0.5 / 1.25;

/// Where a ramp's first corners lie, in N.
constexpr double ramp_corners[] = {1.0 / 128, 1.0 / 32, 1.0 / 8, 1.0 / 2, 1};
constexpr int ramp_count = static_cast<int>(sizeof ramp_corners / sizeof *ramp_corners);

struct Chord {
	Vec3 from, to;       ///< on the path
	Mark at_from, at_to; ///< where on it: for Path::tangent()
	double nearest;      ///< no point of the chord is nearer to the centre
	double farthest;     ///< none is farther
};

/// A few chords in a row, taken as one: their arc stays near the long chord, since a path bends one way only.
struct Arc {
	Vec3 from, to;
	double bulge;             ///< no point of the arc is farther from the long chord
	double nearest, farthest; ///< as a chord's
	double length;            ///< of the arc, as of a cubic
	int chords;               ///< at most
};

/// Walks a solved path chord by chord. The path must outlive it and not change.
class Chords {
public:
	/// ramp: starts with short chords, for a ray that leaves a surface and must not fall back through it.
	Chords(const Path& path, double tolerance, bool ramp);
	/// The next chord; false after the last. Chords of a ray that starts inside the horizon begin where it emerges.
	bool next(Chord& chord);
	/// The next so many chords as one, or a single one where the path is so straight that its width counts, not its bend;
	/// false after the last. To walk them one by one after all, keep a bookmark from before.
	bool next(Arc& arc, int chords);

	/// Where the walk stands, and to go on from where it stood.
	using Bookmark = Chords;
	Bookmark bookmark() const { return *this; }
	void go_to(const Bookmark& there) { *this = there; }
	Vec3 tangent(const Mark& mark) const { return path_->tangent(mark); }

private:
	double density(std::size_t node) const;
	bool advance(double target, double most);
	void look();
	void place();
	void place_end();
	double target(int count) const;
	Vec2 velocity() const;

	const Path* path_;
	double tolerance_, scale_, widest_;
	std::size_t i_ = 0;      // the piece
	double t_ = 0;           // where on it
	double n_ = 0;           // N from which chords are counted
	double piece_n_ = 0;     // N at the start of the piece
	double d0_ = 0, d1_ = 0; // density at its ends
	double length_ = 0;      // its length in s
	int count_ = 0;
	bool ramp_, ended_ = false;
	Piece curve_{{0, 1, 0, 0}, {1, 1, 0, 0}}; // u on the piece
	Vec2 place_{};                            // the point in the orbit's plane, and in space
	Vec3 point_;
	double r_ = 0, phi_ = 0;               // of the point
	double cosine_ = 1, sine_ = 0;         // of the angle at the piece's start
	std::size_t looked_ = std::size_t(-1); // the piece that curve_, cosine_ and sine_ are of
	void load(std::size_t i);
};

} // namespace blackhole

#endif
