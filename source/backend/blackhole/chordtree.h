// SPDX-License-Identifier: AGPL-3.0-or-later
/// Which of a scene's objects a chord of a bent ray, or an arc of several, may hit: a tree of boxes of our own.
///
/// POV-Ray's own trees do not exist under every bounding option, and know no arcs; with this one the same objects are tried whatever the
/// options are. Boxes are in single precision, four to a node, and rounded outward.
#ifndef POVRAY_BLACKHOLE_CHORDTREE_H
#define POVRAY_BLACKHOLE_CHORDTREE_H

#include <utility>
#include <vector>

#include "backend/math/vector.h"
#include "backend/blackhole/reach.h"
#include "backend/blackhole/solidbounds.h"
#include "blackhole/chords.h"
#include "blackhole/four.h"

namespace pov
{

class Plane;

/// A blackhole::Chord, or an Arc with its bulge, as the scene has it.
template<typename Piece>
inline void In_Scene(const Piece& piece, DBL bulge, const Blackhole& hole, Scene_Chord& chord)
{
	hole.To_Scene(piece.from, chord.from);
	hole.To_Scene(piece.to, chord.to);
	chord.bulge = bulge * hole.Radius;
	chord.nearest = piece.nearest;
	chord.farthest = piece.farthest;
}

class Chord_Tree
{
	public:
		typedef std::vector<std::pair<DBL, DBL> > Radii_List;
		typedef std::vector<unsigned int> Object_List;

		/// Takes what a ray can hit. margin: how far before its start a chord accepts a hit, scene units.
		void Build(const std::vector<ObjectPtr>& scene, DBL margin);
		/// The radii at which the objects may be hit around a hole, for Find().
		Radii_List Radii_Around(const Blackhole& hole) const;
		bool Empty() const { return objects.empty(); }
		ObjectPtr Object(unsigned int i) const { return objects[i]; }
		size_t Count() const { return objects.size(); }
		DBL Margin() const { return margin; }
		/// A sphere about an object, wider by the margin, in Schwarzschild radii from the hole. False if the object has no useful bounds.
		bool Ball(unsigned int object, const Blackhole& hole, blackhole::Vec3& center, DBL& radius) const;

		/// The objects that a chord, or an arc, may hit, in ascending order.
		void Find(const Scene_Chord& chord, const Radii_List& radii, Object_List& out) const;
		/// Of these objects those that it may hit.
		void Choose(const Scene_Chord& chord, const Radii_List& radii, const Object_List& of, Object_List& out) const;
		bool May_Hit(const Scene_Chord& chord, const Radii_List& radii, unsigned int object) const;
	private:
		typedef blackhole::Four Four;
		/// The boxes of four children, their lower and upper sides; a child > 0 is a node, < 0 the object ~child, 0 nothing.
		struct Node
		{
			Four side[2][3];
			int child[4];
		};
		int Split(std::vector<int>& list, size_t from, size_t to);

		DBL margin;
		std::vector<ObjectPtr> objects;
		std::vector<Scene_Box> boxes;      ///< of the objects
		std::vector<Node> nodes;           ///< the first is the root
		std::vector<const Plane *> planes; ///< of the objects; or NULL
		std::vector<int> solids;           ///< of the objects: their place in bounds; or -1
		std::vector<Solid_Bounds> bounds;
		Object_List endless;               ///< objects without a useful box
};

}

#endif
