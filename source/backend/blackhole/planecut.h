// SPDX-License-Identifier: AGPL-3.0-or-later
/// What the plane of a ray's orbit cuts of the objects around a hole: where they are few, most rays miss most of them by their plane
/// alone, and of the others discs and lines in that plane are left, to be compared with flat pieces.
///
/// Lengths are in Schwarzschild radii, places relative to the hole. In single precision, rounded outward.
#ifndef POVRAY_BLACKHOLE_PLANECUT_H
#define POVRAY_BLACKHOLE_PLANECUT_H

#include <utility>
#include <vector>

#include "backend/frame.h"
#include "blackhole/route.h"

namespace pov
{

class Blackhole;
class Chord_Tree;

/// The objects around a hole, where they are few.
class Few_Objects
{
	public:
		/// So many with bounds, without, and planes; more are better found in a tree.
		static const size_t MOST = 128, MOST_ANYWHERE = 8, MOST_PLANES = 8;

		/// Takes the objects that can be hit around the hole, if they are few.
		Few_Objects(const Chord_Tree& tree, const std::vector<std::pair<DBL, DBL> >& radii, const Blackhole& hole);
		bool Few() const { return few; }
	private:
		friend class Plane_Cut;
		struct Object
		{
			unsigned int number;       ///< in the tree
			std::pair<DBL, DBL> shell; ///< the radii at which it can be hit
		};
		/// A sphere, or one about something.
		struct Ball
		{
			Object object;
			blackhole::Vec3 center;
			DBL radius;
		};
		size_t Add(const std::vector<Ball>& some);
		struct Spheres { blackhole::Four x, y, z, square; }; ///< of the radius
		struct Plane
		{
			unsigned int number;
			blackhole::Vec3 normal;
			DBL distance; ///< x dot normal = -distance
		};
		std::vector<Spheres> fours;
		std::vector<Object> balls;    ///< of the same, one by one
		size_t smooth;                ///< the first that are spheres themselves
		std::vector<Object> anywhere; ///< what has no bounds
		std::vector<Plane> planes;
		DBL margin;
		bool few;
};

class Plane_Cut
{
	public:
		/// Bit by bit what the plane cuts.
		typedef unsigned long long Set;

		/// The plane through the centre with these unit axes. The objects must stay. False if it cuts too many of them.
		bool Begin(const Few_Objects& objects, const blackhole::Vec3& e1, const blackhole::Vec3& e2);
		/// What each of four pieces may hit.
		void Near(const blackhole::Pieces& pieces, Set *near) const;
		/// Of what only a sphere about it is compared, or nothing.
		Set Rough() const { return rough; }
		/// The number, in the tree, of the least bit's object.
		unsigned int First(Set set) const;
	private:
		typedef blackhole::Four Four;
		static const size_t MOST = 32, PLANES_AT = MOST, ANYWHERE_AT = PLANES_AT + Few_Objects::MOST_PLANES;
		struct Disc
		{
			Four x, y, radius; ///< four times the same
			size_t ball;
		};
		struct Line
		{
			Four x, y, distance; ///< likewise
			float close;
		};
		const Few_Objects *objects;
		Set rough;
		size_t discs, lines;
		Disc disc[MOST];
		Line line[Few_Objects::MOST_PLANES];
};

}

#endif
