// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/blackhole/bentpath.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/blackholes.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::Vec3;

// POV-Ray drops hits nearer than MIN_ISECT_DEPTH to a ray's start, and some shapes drop more (Blind_Depth in reach.h).
// Chords after the first therefore start early, by twice the most that any shape here is blind for, though not behind
// the ray's own origin ...
static DBL Back_Up(bool moved, DBL travelled, DBL blind)
{
	return moved ? min(2.0 * blind, 0.9 * travelled) : 0.0;
}

// ... and accept what lies beyond the joint, less a little so that rounding, or vague hits, on both sides leave no gap: the
// least depth a hit may have, on a chord of this length. It also is as far from the ray's own origin as POV-Ray wants it.
static DBL Least_Depth(DBL back, DBL vague, DBL travelled, DBL length)
{
	if(back == 0.0)
		return 0.0;
	const DBL overlap = min(0.5 * back, max(vague, min(0.2 * MIN_ISECT_DEPTH, 1e-3 * length)));
	return max(back - overlap, back + MIN_ISECT_DEPTH - travelled);
}

// A surface exactly at the horizon is not outside it; intersections are good to far less than this part of its radius.
static const DBL HORIZON = 1e-6;

// Keeps what POV-Ray keeps, beyond the joint and outside the horizon.
struct Chord_Condition : public RayObjectCondition
{
	Chord_Condition(const RayObjectCondition& c, DBL l, const Blackhole *h) : condition(c), least(l), hole(h) { }
	virtual bool operator()(const Ray& ray, const ObjectBase *object, DBL depth) const
	{
		if(depth < least)
			return false;
		if(hole != NULL)
		{
			VECTOR p;
			VEvaluateRay(p, ray.Origin, depth, ray.Direction);
			if(hole->Distance(p) <= hole->Radius * (1.0 + HORIZON))
				return false;
		}
		return condition(ray, object, depth);
	}
	const RayObjectCondition& condition;
	DBL least;
	const Blackhole *hole;
};

// The nearest hit of the chord in hand among these objects, nearer than isect.Depth.
bool Bent_Path::Nearest_Of(const std::vector<unsigned int>& objects, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	bool hit = false;
	for(size_t i = 0; i < objects.size(); i++)
	{
		const ObjectPtr object = bent->holes.Tree().Object(objects[i]);
		Intersection here;
		if(!pre(state->chord, object, 0.0))
			continue;
		bent->counts.Object_Tests++;
		if(bent->trace.FindIntersection(object, here, state->chord, post, isect.Depth) && (here.Depth < isect.Depth))
		{
			isect = here;
			hit = true;
		}
	}
	return hit;
}

// Few enough to be tried one by one on a straight leg, without a walk through POV-Ray's tree.
static const size_t FEW = 4;

// Looks for a hit on a straight piece of the way; on return the chord in hand is that piece, and a hit's depth is from its start.
bool Bent_Path::Search(const VECTOR from, const Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const DBL back = Back_Up(s.moved, s.travelled, bent->holes.Blind());
	Assign_Vec3(s.chord.Direction, direction);
	VEvaluateRay(s.chord.Origin, from, -back, s.chord.Direction);
	isect.Depth = length + back;
	const Chord_Condition condition(post, Least_Depth(back, bent->holes.Vague(), s.travelled, length), NULL);
	const std::vector<unsigned int>& outside = bent->holes.Outside();
	const bool found = outside.size() <= FEW ? Nearest_Of(outside, isect, pre, condition) : bent->trace.FindIntersection(isect, s.chord, pre, condition);
	Assign_Vector(s.chord.Origin, from);
	isect.Depth = max(0.0, isect.Depth - back);
	return found;
}

// The same in a scene without objects.
bool Bent_Path::Nothing_There(const VECTOR from, const Vec3& direction, DBL length, Intersection& isect)
{
	Assign_Vec3(state->chord.Direction, direction);
	Assign_Vector(state->chord.Origin, from);
	isect.Depth = length;
	return false;
}

// The same on a chord, among these objects only.
bool Bent_Path::Hit_Chord(const Scene_Chord& chord, const Vec3& direction, DBL length, const std::vector<unsigned int>& objects, const Blackhole& hole, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const DBL blind = bent->holes.Blind(), back = Back_Up(s.moved, s.travelled, blind);
	const bool near_horizon = (chord.nearest <= 1.0 + 2.0 * HORIZON) || ((chord.nearest - 1.0) * hole.Radius < 2.0 * blind);
	Assign_Vec3(s.chord.Direction, direction);
	VEvaluateRay(s.chord.Origin, chord.from, -back, s.chord.Direction);
	isect.Depth = length + back;
	const Chord_Condition condition(post, Least_Depth(back, bent->holes.Vague(), s.travelled, length), near_horizon ? &hole : NULL);
	const bool hit = Nearest_Of(objects, isect, pre, condition);
	Assign_Vector(s.chord.Origin, chord.from);
	isect.Depth = max(0.0, isect.Depth - back);
	return hit;
}

// One chord, among these objects. True if it is the ray's last: something is hit, or state->end is set.
template<typename Walk>
bool Bent_Path::Along_Chord(const Walk& walk, const blackhole::Chord& marks, const Scene_Chord& chord, const std::vector<unsigned int>& objects, size_t index, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post, bool& found)
{
	Bent_Segment& s = *state;
	Blackhole_Counts& counts = bent->counts;
	const Blackhole& hole = *bent->holes.Holes()[index];
	Vec3 along = Vec3_Of(chord.to) - Vec3_Of(chord.from);
	const DBL chord_length = length(along), remains = s.budget - s.travelled;
	found = false;
	s.chords++;
	(objects.empty() ? counts.Skipped : counts.Tested)++;
	if(!objects.empty())
		counts.Add_Tested(index, bent->holes.Shells_Of(index), chord.nearest, chord.farthest);
	if(chord_length == 0.0)
		return false;
	along = (1.0 / chord_length) * along;
	found = !objects.empty() && Hit_Chord(chord, along, min(chord_length, remains), objects, hole, isect, pre, post);
	s.moved = true;
	Record(chord.from, found ? isect.IPoint : chord.to, index, !objects.empty());
	if(found)
	{
		counts.Hits++;
		// The quadratic through both tangents whose mean is the chord.
		const DBL t = min(1.0, isect.Depth / chord_length);
		const Vec3 from = walk.tangent(marks.at_from), to = walk.tangent(marks.at_to);
		s.tangent = unit((1.0 - 4.0 * t + 3.0 * t * t) * from + (3.0 * t * t - 2.0 * t) * to + (6.0 * t - 6.0 * t * t) * along);
		s.has_tangent = true;
		return true;
	}
	if(chord_length >= remains)
	{
		Assign_Vector(s.chord.Origin, chord.from);
		Assign_Vec3(s.chord.Direction, along);
		isect.Depth = remains;
		s.end = "max distance";
		return true;
	}
	Pass(chord.from, along, chord_length);
	return false;
}

// Along every chord. False if nothing is hit; state->end may be set. emerges: from inside the horizon.
template<typename Walk>
bool Bent_Path::Along_Chords(Walk& walk, size_t index, bool emerges, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	const Blackhole& hole = *bent->holes.Holes()[index];
	blackhole::Chord c;
	Scene_Chord chord;
	bool found;
	for(; walk.next(c); emerges = false)
	{
		In_Scene(c, 0.0, hole, chord);
		if(emerges)
			Emerge(chord.from);
		bent->holes.Tree().Find(chord, bent->holes.Radii_Of(index), bent->candidates);
		if(Along_Chord(walk, c, chord, bent->candidates, index, isect, pre, post, found))
			return found;
	}
	return false;
}

// The same where only hits count: arcs of several chords are looked at first, of these shorter ones where something may be, and
// chords only where it still may.
template<typename Walk>
bool Bent_Path::Along_Arcs(Walk& walk, size_t index, int chords, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	const Blackhole& hole = *bent->holes.Holes()[index];
	const Chord_Tree& tree = bent->holes.Tree();
	const Chord_Tree::Radii_List& radii = bent->holes.Radii_Of(index);
	const int fewer = max(1, int(sqrt(DBL(chords)) + 0.5));
	blackhole::Arc arc, part;
	blackhole::Chord c;
	Scene_Chord chord;
	bool found;
	for(;;)
	{
		const typename Walk::Bookmark here = walk.bookmark();
		if(!walk.next(arc, chords))
			return false;
		In_Scene(arc, arc.bulge, hole, chord);
		tree.Find(chord, radii, bent->candidates);
		if(bent->candidates.empty())
		{
			Skip(arc.chords, arc.length * hole.Radius);
			continue;
		}
		walk.go_to(here);
		for(int i = 0; i < arc.chords; i += part.chords)
		{
			const typename Walk::Bookmark there = walk.bookmark();
			if(!walk.next(part, min(fewer, arc.chords - i)))
				break;
			In_Scene(part, part.bulge, hole, chord);
			tree.Choose(chord, radii, bent->candidates, bent->fewer);
			if(bent->fewer.empty())
			{
				Skip(part.chords, part.length * hole.Radius);
				continue;
			}
			walk.go_to(there);
			for(int j = 0; (j < part.chords) && walk.next(c); j++)
			{
				In_Scene(c, 0.0, hole, chord);
				tree.Choose(chord, radii, bent->fewer, bent->chosen);
				if(bent->chosen.empty())
					Skip(1, length(c.to - c.from) * hole.Radius);
				else if(Along_Chord(walk, c, chord, bent->chosen, index, isect, pre, post, found))
					return found;
			}
		}
	}
}

// Nothing is near these chords, of a length in the scene.
void Bent_Path::Skip(int chords, DBL length)
{
	bent->counts.Skipped += chords;
	state->chords += chords;
	state->travelled += length;
	state->moved = true;
}

template<typename Walk>
bool Bent_Path::Along(Walk& walk, size_t index, bool emerges, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	// As many chords as turn by a third of a radian or so; a single one is no arc.
	const int in_arc = min(32, int(0.25 / sqrt(bent->holes.Holes()[index]->Tolerance)));
	return (in_arc < 2) || Every_Chord() || emerges ? Along_Chords(walk, index, emerges, isect, pre, post) : Along_Arcs(walk, index, in_arc, isect, pre, post);
}

template bool Bent_Path::Along(blackhole::Chords& walk, size_t index, bool emerges, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
template bool Bent_Path::Along(blackhole::Route& walk, size_t index, bool emerges, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
template bool Bent_Path::Along_Chord(const blackhole::Route& walk, const blackhole::Chord& marks, const Scene_Chord& chord, const std::vector<unsigned int>& objects, size_t index, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post, bool& found);

}
