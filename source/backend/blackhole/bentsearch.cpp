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

// Looks for a hit on a straight piece of the way; on return the chord in hand is that piece, and a hit's depth is from its start.
bool Bent_Path::Search(const VECTOR from, const Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const DBL back = Back_Up(s.moved, s.travelled, bent->holes.Blind());
	Assign_Vec3(s.chord.Direction, direction);
	VEvaluateRay(s.chord.Origin, from, -back, s.chord.Direction);
	isect.Depth = length + back;
	const Chord_Condition condition(post, Least_Depth(back, bent->holes.Vague(), s.travelled, length), NULL);
	const bool found = bent->trace.FindIntersection(isect, s.chord, pre, condition);
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
bool Bent_Path::Hit_Chord(const Chord_Run::Chord& chord, const Vec3& direction, DBL length, const std::vector<unsigned int>& objects, const Blackhole& hole, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const DBL blind = bent->holes.Blind(), back = Back_Up(s.moved, s.travelled, blind);
	const bool near_horizon = (chord.nearest <= 1.0 + 2.0 * HORIZON) || ((chord.nearest - 1.0) * hole.Radius < 2.0 * blind);
	Assign_Vec3(s.chord.Direction, direction);
	VEvaluateRay(s.chord.Origin, chord.from, -back, s.chord.Direction);
	isect.Depth = length + back;
	const Chord_Condition condition(post, Least_Depth(back, bent->holes.Vague(), s.travelled, length), near_horizon ? &hole : NULL);
	bool hit = false;
	for(size_t i = 0; i < objects.size(); i++)
	{
		const ObjectPtr object = bent->holes.Tree().Object(objects[i]);
		Intersection here;
		if(!pre(s.chord, object, 0.0))
			continue;
		bent->counts.Object_Tests++;
		if(bent->trace.FindIntersection(object, here, s.chord, condition, isect.Depth) && (here.Depth < isect.Depth))
		{
			isect = here;
			hit = true;
		}
	}
	Assign_Vector(s.chord.Origin, chord.from);
	isect.Depth = max(0.0, isect.Depth - back);
	return hit;
}

// One chord, among these objects. True if it is the ray's last: something is hit, or state->end is set.
bool Bent_Path::Along_Chord(const Chord_Run::Chord& chord, const std::vector<unsigned int>& objects, size_t index, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post, bool& found)
{
	Bent_Segment& s = *state;
	Blackhole_Counts& counts = bent->counts;
	const Blackhole& hole = *bent->holes.Holes()[index];
	Vec3 along = Vec3_Of(chord.to) - Vec3_Of(chord.from);
	const DBL chord_length = length(along), remains = s.budget - s.travelled;
	found = false;
	counts.Chords++;
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
		const Vec3 from = bent->path.tangent(chord.at_from), to = bent->path.tangent(chord.at_to);
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

// Along every chord of the path that was solved last, a run of them at a time. False if nothing is hit; state->end may be set.
bool Bent_Path::Along_Chords(size_t index, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	const Blackhole& hole = *bent->holes.Holes()[index];
	Chord_Run& run = bent->run;
	Chord_Candidates& candidates = bent->candidates;
	blackhole::Chords chords(bent->path, hole.Tolerance, !state->moved && !original.IsPrimaryRay());
	blackhole::Chord c;
	bool emerges = bent->path.started_inside(), found;
	for(bool more = true; more; )
	{
		run.Clear();
		while((run.Count() < Chord_Run::MOST) && (more = chords.next(c)))
		{
			VECTOR start, end;
			hole.To_Scene(c.from, start);
			hole.To_Scene(c.to, end);
			if(emerges)
				Emerge(start);
			emerges = false;
			run.Add(start, end, c);
		}
		bent->holes.Tree().Find(run, bent->holes.Radii_Of(index), candidates);
		for(int i = 0; i < run.Count(); i++)
		{
			candidates.Take(i);
			if(Along_Chord(run[i], candidates.objects, index, isect, pre, post, found))
				return found;
		}
	}
	return false;
}

// The same where only hits count: arcs of several chords are looked at first, and their chords only where something may be.
bool Bent_Path::Along_Arcs(size_t index, int chords, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const Blackhole& hole = *bent->holes.Holes()[index];
	const Chord_Tree& tree = bent->holes.Tree();
	Chord_Run& run = bent->run;
	Chord_Candidates& candidates = bent->candidates;
	blackhole::Chords walk(bent->path, hole.Tolerance, !s.moved && !original.IsPrimaryRay());
	blackhole::Arc arc;
	blackhole::Chord c;
	bool found;
	for(bool more = true; more; )
	{
		run.Clear();
		bent->walks.clear();
		for(; run.Count() < Chord_Run::MOST; )
		{
			bent->walks.push_back(walk);
			if(!(more = walk.next(arc, chords)))
				break;
			VECTOR start, end;
			hole.To_Scene(arc.from, start);
			hole.To_Scene(arc.to, end);
			run.Add(start, end, arc.bulge * hole.Radius, arc);
		}
		tree.Find(run, bent->holes.Radii_Of(index), candidates);
		for(int i = 0; i < run.Count(); i++)
		{
			candidates.Take(i);
			if(candidates.objects.empty())
			{
				const DBL length = run[i].length * hole.Radius;
				bent->counts.Chords += run[i].chords;
				bent->counts.Skipped += run[i].chords;
				s.chords += run[i].chords;
				s.travelled += length;
				s.moved = true;
				continue;
			}
			blackhole::Chords& one = bent->walks[i];
			Chord_Run::Chord chord;
			for(int j = 0; (j < run[i].chords) && one.next(c); j++)
			{
				hole.To_Scene(c.from, chord.from);
				hole.To_Scene(c.to, chord.to);
				chord.Set(c);
				tree.Choose(chord, bent->holes.Radii_Of(index), candidates.objects, bent->chosen);
				if(Along_Chord(chord, bent->chosen, index, isect, pre, post, found))
					return found;
			}
		}
	}
	return false;
}

}
