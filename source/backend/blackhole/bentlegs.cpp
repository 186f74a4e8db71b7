// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/bounding/bbox.h"
#include "backend/interior/interior.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/blackhole/bentpath.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/blackholes.h"
#include "blackhole/closed.h"

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

void Bent_Path::Record(const VECTOR from, const VECTOR to, size_t hole, bool tested)
{
	if(bent->recorder == NULL)
		return;
	Recorded_Ray::Chord c = { Vec3_Of(from), Vec3_Of(to), hole == NO_HOLE ? -1 : int(hole), tested };
	bent->recorder->rays[state->record].Chords.push_back(c);
}

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

// The same on a chord, among its candidates only; they are used up.
bool Bent_Path::Hit_Chord(const Chord_Run::Chord& chord, const Vec3& direction, DBL length, size_t& candidate, const Blackhole& hole, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const std::vector<std::pair<int, unsigned int> >& found = bent->candidates.found;
	const int index = found[candidate].first;
	const DBL blind = bent->holes.Blind(), back = Back_Up(s.moved, s.travelled, blind);
	const bool near_horizon = (chord.nearest <= 1.0 + 2.0 * HORIZON) || ((chord.nearest - 1.0) * hole.Radius < 2.0 * blind);
	Assign_Vec3(s.chord.Direction, direction);
	VEvaluateRay(s.chord.Origin, chord.from, -back, s.chord.Direction);
	isect.Depth = length + back;
	const Chord_Condition condition(post, Least_Depth(back, bent->holes.Vague(), s.travelled, length), near_horizon ? &hole : NULL);
	bool hit = false;
	for(; (candidate < found.size()) && (found[candidate].first == index); candidate++)
	{
		const ObjectPtr object = bent->holes.Tree().Object(found[candidate].second);
		Intersection here;
		if(pre(s.chord, object, 0.0) && bent->trace.FindIntersection(object, here, s.chord, condition, isect.Depth) && (here.Depth < isect.Depth))
		{
			isect = here;
			hit = true;
		}
	}
	Assign_Vector(s.chord.Origin, chord.from);
	isect.Depth = max(0.0, isect.Depth - back);
	return hit;
}

// A piece of the way that hit nothing.
void Bent_Path::Pass(const VECTOR from, const Vec3& direction, DBL length)
{
	if(state->volume)
	{
		Bent_Segment::Span span;
		Assign_Vector(span.from, from);
		Assign_Vec3(span.direction, direction);
		span.length = length;
		state->spans.push_back(span);
	}
	state->travelled += length;
}

// A leg outside all spheres, of the length given.
bool Bent_Path::Straight(const VECTOR from, const Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const bool found = bent->holes.Tree().Empty() ? Nothing_There(from, direction, length, isect) : Search(from, direction, length, isect, pre, post);
	s.has_tangent = false;
	if(bent->recorder != NULL)
	{
		// What goes to infinity is drawn as far as the farthest sphere is wide.
		DBL drawn = 10.0;
		for(size_t i = 0; i < bent->holes.Holes().size(); i++)
			drawn = max(drawn, 0.5 * bent->holes.Holes()[i]->Reach());
		VECTOR to;
		VEvaluateRay(to, from, found || (length < BOUND_HUGE / 2.0) ? isect.Depth : drawn, s.chord.Direction);
		Record(from, to, NO_HOLE, true);
	}
	s.moved = true;
	return found;
}

// Along the chords of the path that was solved last, a run of them at a time. False if nothing is hit; state->end may be set.
bool Bent_Path::Along_Chords(size_t index, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const Blackhole& hole = *bent->holes.Holes()[index];
	const Shells& shells = bent->holes.Shells_Of(index);
	Blackhole_Counts& counts = bent->counts;
	Chord_Run& run = bent->run;
	blackhole::Chords chords(bent->path, hole.Tolerance, !s.moved && !original.IsPrimaryRay());
	blackhole::Chord c;
	bool emerges = bent->path.started_inside();
	for(bool more = true; more; )
	{
		run.Clear();
		DBL nearest = HUGE_VAL, farthest = 0.0;
		while((run.Count() < Chord_Run::MOST) && (more = chords.next(c)))
		{
			VECTOR start, end;
			hole.To_Scene(c.from, start);
			hole.To_Scene(c.to, end);
			if(emerges)
				Emerge(start);
			emerges = false;
			nearest = min(nearest, c.nearest);
			farthest = max(farthest, c.farthest);
			run.Add(start, end, c);
		}
		bent->candidates.found.clear();
		if(shells.Overlap(nearest, farthest))
		{
			run.Bound();
			bent->holes.Tree().Find(run, bent->holes.Radii_Of(index), bent->candidates);
		}
		size_t candidate = 0;
		for(int i = 0; i < run.Count(); i++)
		{
			const Chord_Run::Chord& chord = run[i];
			Vec3 along = Vec3_Of(chord.to) - Vec3_Of(chord.from);
			const DBL chord_length = length(along), remains = s.budget - s.travelled;
			const bool test = (candidate < bent->candidates.found.size()) && (bent->candidates.found[candidate].first == i);
			counts.Chords++;
			s.chords++;
			(test ? counts.Tested : counts.Skipped)++;
			if(chord_length == 0.0)
			{
				while((candidate < bent->candidates.found.size()) && (bent->candidates.found[candidate].first == i))
					candidate++;
				continue;
			}
			along = (1.0 / chord_length) * along;
			const bool found = test && Hit_Chord(chord, along, min(chord_length, remains), candidate, hole, isect, pre, post);
			s.moved = true;
			Record(chord.from, found ? isect.IPoint : chord.to, index, test);
			if(found)
			{
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
				return false;
			}
			Pass(chord.from, along, chord_length);
		}
	}
	return false;
}

// Through one effect sphere where nothing happens on the way: the closed form alone.
bool Bent_Path::Leave(const Blackhole& hole, VECTOR from, Vec3& direction)
{
	Bent_Segment& s = *state;
	blackhole::Escape exit;
	s.moved = true;
	s.captured = !escape(hole.To_Hole(from), direction, hole.Settings().effect_radius, exit);
	bent->counts.Captured += s.captured;
	if(s.captured)
		return false;
	bent->counts.Most_Swept = max(bent->counts.Most_Swept, exit.phi);
	direction = exit.tangent;
	hole.To_Scene(hole.Settings().effect_radius * exit.at, from);
	Assign_Vec3(s.chord.Direction, direction);
	Assign_Vector(s.chord.Origin, from);
	return false;
}

// Through one effect sphere. On true the chord in hand hit something; otherwise from and direction are where the
// ray left the sphere, unless it was captured or ended (state->end).
bool Bent_Path::Through(size_t index, VECTOR from, Vec3& direction, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const Blackhole& hole = *bent->holes.Holes()[index];
	const Shells& shells = bent->holes.Shells_Of(index);
	Blackhole_Counts& counts = bent->counts;
	// Only what the scene requires: no chords where nothing can be hit, filled, recorded or measured along them; and no path
	// where its length is not wanted either, by something beyond the sphere that fades, or radiosity.
	const bool chords = !shells.Empty() || s.volume || (bent->recorder != NULL) || (s.budget < BOUND_HUGE);
	counts.Entered++;
	if(!chords && !bent->holes.Far_Objects())
		return Leave(hole, from, direction);
	blackhole::Path& path = bent->path;
	const bool solved = path.solve(hole.To_Hole(from), direction, hole.Settings());
	const bool captured = (path.outcome() == blackhole::Outcome::captured);

	counts.Captured += captured;
	counts.Nudged += path.nudged();
	counts.Failed += !solved;
	counts.Most_Swept = max(counts.Most_Swept, path.swept());
	s.drift = max(s.drift, path.drift());
	if(!path.nudged())
		counts.Drift = max(counts.Drift, path.drift());

	if(chords)
	{
		if(Along_Chords(index, isect, pre, post))
			return true;
		if(*s.end != 0)
			return false;
	}
	else if(!captured)
		s.travelled += path.length() * hole.Radius;
	s.moved = true;
	s.captured = captured;
	if(captured)
	{
		// The last chord before the horizon is the one in hand: its fog is in front of the black.
		isect.Depth = 0.0;
		if(!s.spans.empty())
		{
			Assign_Vector(s.chord.Origin, s.spans.back().from);
			Assign_Vector(s.chord.Direction, s.spans.back().direction);
			isect.Depth = s.spans.back().length;
			s.travelled -= isect.Depth;
			s.spans.pop_back();
		}
		return false;
	}
	direction = path.end_tangent();
	hole.To_Scene(path.end(), from);
	Assign_Vec3(s.chord.Direction, direction);
	Assign_Vector(s.chord.Origin, from);
	if(!solved)
		s.end = "failed";
	return false;
}

// A ray from inside the horizon begins to exist for the scene where it comes out, in whatever contains that point.
void Bent_Path::Emerge(const VECTOR point)
{
	const SceneData& scene = bent->scene;
	state->chord.ClearInteriors();
	for(size_t i = 0; i < scene.objects.size(); i++)
	{
		ObjectPtr object = scene.objects[i];
		if((object->interior != NULL) && Inside_BBox(point, object->BBox) && object->Inside(point, bent->trace.threadData))
			state->chord.AppendInterior(object->interior);
	}
	Set_Volume();
}

}
