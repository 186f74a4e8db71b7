// SPDX-License-Identifier: AGPL-3.0-or-later
/// Which of a scene's objects each chord of a bent ray may hit: one walk of a tree of boxes with many chords at once.
///
/// POV-Ray's own trees know one straight ray at a time, and do not exist under every bounding option; with this one the
/// same objects are tried whatever the options are.
#ifndef POVRAY_BLACKHOLE_CHORDTREE_H
#define POVRAY_BLACKHOLE_CHORDTREE_H

#include <utility>
#include <vector>

#include "backend/math/vector.h"
#include "backend/blackhole/reach.h"
#include "blackhole/chords.h"

namespace pov
{

/// Up to sixteen chords in a row, in scene coordinates, with boxes round each and round each run of two, four, ...
class Chord_Run
{
	public:
		static const int MOST = 16;

		struct Box
		{
			DBL lo[3], hi[3];
			DBL widest; ///< hi - lo at most
		};

		void Clear() { count = 0; }
		void Add(const VECTOR from, const VECTOR to, const blackhole::Chord& chord)
		{
			Chord& c = chords[count++];
			Assign_Vector(c.from, from);
			Assign_Vector(c.to, to);
			c.Set(chord);
			arcs = false;
		}
		/// A run holds either chords or arcs.
		void Add(const VECTOR from, const VECTOR to, DBL bulge, const blackhole::Arc& arc)
		{
			Chord& c = chords[count++];
			Assign_Vector(c.from, from);
			Assign_Vector(c.to, to);
			c.bulge = bulge;
			c.nearest = arc.nearest;
			c.farthest = arc.farthest;
			c.length = arc.length;
			c.chords = arc.chords;
			arcs = true;
		}

		struct Chord
		{
			VECTOR from, to;
			DBL bulge; ///< of an arc, scene units
			DBL nearest, farthest; ///< to the hole's centre, in Schwarzschild radii
			blackhole::Mark at_from, at_to;
			DBL length; ///< of an arc, in Schwarzschild radii
			int chords; ///< of an arc

			void Set(const blackhole::Chord& c)
			{
				nearest = c.nearest;
				farthest = c.farthest;
				at_from = c.at_from;
				at_to = c.at_to;
			}
		};
		int Count() const { return count; }
		bool Arcs() const { return arcs; }
		/// Makes the boxes; to be called when all are there.
		void Bound();
		const Chord& operator[](int i) const { return chords[i]; }
		/// The boxes as a heap: 1 holds all, 2 i and 2 i + 1 are the halves of i, chord j is MOST + j.
		const Box& Heap(int i) const { return boxes[i]; }
	private:
		int count;
		bool arcs;
		Chord chords[MOST];
		Box boxes[2 * MOST];
};

/// A thread's working space, and the pairs that were found: chord and object, in that order.
struct Chord_Candidates
{
	std::vector<std::pair<int, unsigned int> > found; ///< sorted
	std::vector<std::pair<int, int> > stack;
	size_t taken;
	std::vector<unsigned int> objects; ///< of the chord taken last

	/// Takes a chord's objects; chords in ascending order.
	void Take(int chord)
	{
		objects.clear();
		for(; (taken < found.size()) && (found[taken].first == chord); taken++)
			objects.push_back(found[taken].second);
	}
};

class Plane;

class Chord_Tree
{
	public:
		/// Takes what a ray can hit. margin: how far before its start a chord accepts a hit, scene units.
		void Build(const std::vector<ObjectPtr>& scene, DBL margin);
		/// The radii at which the objects may be hit around a hole, for Find().
		std::vector<std::pair<DBL, DBL> > Radii_Around(const Blackhole& hole) const;
		bool Empty() const { return objects.empty(); }
		ObjectPtr Object(unsigned int i) const { return objects[i]; }

		void Find(Chord_Run& run, const std::vector<std::pair<DBL, DBL> >& radii, Chord_Candidates& out) const;
		/// Of these objects those that a chord may hit.
		void Choose(const Chord_Run::Chord& chord, const std::vector<std::pair<DBL, DBL> >& radii, const std::vector<unsigned int>& of, std::vector<unsigned int>& out) const;
	private:
		struct Node
		{
			Chord_Run::Box box;
			int left;   ///< index of the first of two children; -1: a leaf
			int object; ///< of a leaf
		};
		void Split(int node, std::vector<int>& list, size_t from, size_t to);

		DBL margin;
		std::vector<ObjectPtr> objects;
		std::vector<Chord_Run::Box> boxes; ///< of the objects
		std::vector<Node> nodes;
		std::vector<const Plane *> planes; ///< of the objects; or NULL
		std::vector<unsigned int> endless; ///< objects without a useful box
};

}

#endif
