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

void Bent_Path::Record(const VECTOR from, const VECTOR to, size_t hole, bool tested)
{
	if(bent->recorder == NULL)
		return;
	Recorded_Ray::Chord c = { Vec3_Of(from), Vec3_Of(to), hole == NO_HOLE ? -1 : int(hole), tested };
	bent->recorder->rays[state->record].Chords.push_back(c);
}

// A piece of the way that hit nothing.
void Bent_Path::Pass(const VECTOR from, const Vec3& direction, DBL length)
{
	if(volume)
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

// Out of the sphere: the way goes on straight from here.
void Bent_Path::Leave(VECTOR from, const Vec3& direction)
{
	Assign_Vec3(state->chord.Direction, direction);
	Assign_Vector(state->chord.Origin, from);
}

// A ray without a direction: black, and counted.
bool Bent_Path::Nowhere(Intersection& isect)
{
	bent->counts.Undirected++;
	state->captured = true;
	isect.Depth = 0.0;
	return End_With("horizon", false);
}

// In a scene of one hole and nothing to hit: only the direction in which the ray leaves is wanted.
bool Bent_Path::To_Sky(Intersection& isect)
{
	Bent_Segment& s = *state;
	const Blackhole& hole = *bent->holes.Holes()[0];
	const blackhole::Atlas& atlas = bent->holes.Atlas_Of(0);
	const DBL R = atlas.settings().effect_radius;
	Vec3 direction = Vec3_Of(original.Direction);
	Vec3 x = hole.To_Hole(original.Origin);
	const DBL off = dot(x, x) - R * R, size = dot(direction, direction);
	s.moved = true;
	isect.Depth = s.budget;
	if((off < 0.0) || !(fabs(size - 1.0) <= 1e-12) || (bent->holes.Falling() != NULL))
	{
		VECTOR ignored;
		if(!Enter(ignored, direction))
		{
			bent->counts.Entered++;
			return Swallowed(isect);
		}
		if(!(dot(direction, direction) > 0.5)) // not a number
			return Nowhere(isect);
	}
	const DBL along = dot(x, direction), square = along * along - off;
	// Past the sphere the ray is as it was given, but for the camera's frame.
	if((off >= 0.0) && ((along >= 0.0) || (square <= 0.0)))
	{
		Assign_Vec3(s.chord.Direction, direction);
		return End_With("sky", false);
	}
	blackhole::Escape exit;
	bent->counts.Entered++;
	bool charted = false;
	if(off >= 0.0)
	{
		x = x + (off / (sqrt(square) - along)) * direction;
		charted = atlas.through(x, direction, exit);
	}
	(charted ? bent->counts.Charted : bent->counts.Closed)++;
	if(!charted && !escape(x, direction, R, exit))
		return Swallowed(isect);
	bent->counts.Most_Swept = max(bent->counts.Most_Swept, exit.phi);
	Assign_Vec3(s.chord.Direction, exit.tangent);
	hole.To_Scene(R * exit.at, s.chord.Origin);
	return End_With("sky", false);
}

// Through one effect sphere where nothing happens on the way: where the ray comes out is all.
bool Bent_Path::Only_Exit(const Blackhole& hole, VECTOR from, Vec3& direction)
{
	Bent_Segment& s = *state;
	const DBL R = hole.Rim();
	blackhole::Escape exit;
	s.moved = true;
	s.captured = !escape(hole.To_Hole(from), direction, R, exit);
	bent->counts.Closed++;
	bent->counts.Captured += s.captured;
	if(s.captured)
		return false;
	bent->counts.Most_Swept = max(bent->counts.Most_Swept, exit.phi);
	direction = exit.tangent;
	hole.To_Scene(R * exit.at, from);
	Leave(from, direction);
	return false;
}

// Through one effect sphere. On true the chord in hand hit something; otherwise from and direction are where the
// ray left the sphere, unless it was captured or ended (state->end).
bool Bent_Path::Through(size_t index, VECTOR from, Vec3& direction, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const Blackhole& hole = *bent->holes.Holes()[index];
	const blackhole::Atlas& atlas = bent->holes.Atlas_Of(index);
	Blackhole_Counts& counts = bent->counts;
	// Only what the scene requires: no chords where nothing can be hit, filled, recorded or measured along them; and no path
	// where its length is not wanted either, by something beyond the sphere that fades, or radiosity.
	const bool chords = !bent->holes.Shells_Of(index).Empty() || volume || (bent->recorder != NULL) || (s.budget < BOUND_HUGE);
	counts.Entered++;
	if(!(dot(direction, direction) > 0.5)) // not a number
		return Nowhere(isect);
	if(!chords && !bent->holes.Far_Objects())
		return Only_Exit(hole, from, direction);
	const Vec3 x = hole.To_Hole(from);
	const bool ramp = !s.moved && !original.IsPrimaryRay();
	blackhole::Route& route = bent->route;
	if(route.solve(x, direction, atlas, ramp))
	{
		const DBL drift = route.drift();
		s.drift = max(s.drift, drift);
		counts.Charted++;
		counts.Filled += volume;
		counts.Most_Swept = max(counts.Most_Swept, route.swept());
		counts.Drift = max(counts.Drift, drift);
		counts.Drifted += (drift > hole.Tolerance);
		const bool flat = chords && !Every_Chord() && bent->holes.Few_Of(index).Few() && bent->cut.Begin(bent->holes.Few_Of(index), route.e1(), route.e2());
		if(chords && (flat ? Along_Pieces(index, isect, pre, post) : Along(route, index, false, isect, pre, post)))
			return true;
		return Ended(hole, route, chords, true, from, direction, isect);
	}
	blackhole::Path& path = bent->path;
	const bool solved = path.solve(x, direction, hole.Settings());
	counts.Nudged += path.nudged();
	counts.Paths++;
	counts.Steps += path.nodes().size() - 1;
	counts.Most_Steps = max(counts.Most_Steps, (unsigned int)(path.nodes().size() - 1));
	counts.Filled += volume;
	(path.exhausted() ? counts.Exhausted : counts.Failed) += !solved;
	counts.Most_Swept = max(counts.Most_Swept, path.swept());
	const DBL drift = path.drift();
	s.drift = max(s.drift, drift);
	if(!path.nudged())
	{
		counts.Drift = max(counts.Drift, drift);
		counts.Drifted += (drift > hole.Tolerance);
	}
	if(chords)
	{
		blackhole::Chords walk(path, hole.Tolerance, ramp);
		if(Along(walk, index, path.started_inside(), isect, pre, post))
			return true;
	}
	return Ended(hole, path, chords, solved, from, direction, isect);
}

// At the end of the way through a sphere; Way: a Route or a Path.
template<typename Way>
bool Bent_Path::Ended(const Blackhole& hole, const Way& way, bool chords, bool solved, VECTOR from, Vec3& direction, Intersection& isect)
{
	Bent_Segment& s = *state;
	if(*s.end != 0)
		return false;
	s.moved = true;
	s.captured = (way.outcome() == blackhole::Outcome::captured);
	bent->counts.Captured += s.captured;
	if(s.captured)
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
	if(!chords)
		s.travelled += way.length() * hole.Radius;
	direction = way.end_tangent();
	hole.To_Scene(way.end(), from);
	Leave(from, direction);
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
