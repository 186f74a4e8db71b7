// SPDX-License-Identifier: AGPL-3.0-or-later
/// Whether a chord may hit an object that is made of others, without its box: intersections of planes and quadrics have none
/// that is of use, and are slow to intersect.
///
/// A point on the surface of an intersection lies in every part of it; one of a union, in some part. So a chord that keeps clear of
/// one part's half-space or box cannot hit the former.
#ifndef POVRAY_BLACKHOLE_SOLIDBOUNDS_H
#define POVRAY_BLACKHOLE_SOLIDBOUNDS_H

#include <vector>

#include "backend/frame.h"

namespace pov
{

/// A chord in scene coordinates, or an arc: then all of it is within bulge of the segment.
struct Scene_Chord
{
	VECTOR from, to;
	DBL bulge;             ///< scene units; 0 for a chord
	DBL nearest, farthest; ///< to the hole's centre, in Schwarzschild radii
};

/// A box in scene coordinates.
struct Scene_Box
{
	DBL lo[3], hi[3];

	/// The object's bounding box, wider by margin and by what single precision may have lost.
	void Take(const ObjectBase& object, DBL margin);
	/// Whether the chord comes within its bulge of the box.
	bool Meets(const Scene_Chord& chord) const;
};

class Solid_Bounds
{
	public:
		/// margin: how far before its start a chord accepts a hit, scene units.
		Solid_Bounds(const ObjectBase& object, DBL margin);
		bool May_Hit(const Scene_Chord& chord) const { return Holds(0, chord); }
	private:
		/// Parts in the order of a walk from the top; after: the first that is not of this one.
		struct Part
		{
			enum { ANYTHING, ALL_OF, ANY_OF, HALF_SPACE, BOX } kind;
			size_t after;
			Scene_Box box;
			VECTOR normal;
			DBL distance;
		};
		void Add(const ObjectBase& object, bool part);
		bool Holds(size_t part, const Scene_Chord& chord) const;

		DBL margin;
		std::vector<Part> parts;
};

}

#endif
