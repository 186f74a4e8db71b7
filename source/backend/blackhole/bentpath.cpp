// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <cstring>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/scene.h"
#include "backend/blackhole/bentpath.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/blackholes.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::Vec3;

// A ray may be passed from hole to hole; light that never leaves is as good as captured.
static const int MOST_PASSAGES = 1000;

// As Ray's own assignment, but for its flags, which that takes one by one: seventy instructions. They come last.
static void Copy(Ray& to, const Ray& from)
{
	Assign_Vector(to.Origin, from.Origin);
	Assign_Vector(to.Direction, from.Direction);
	to.GetInteriors() = from.GetInteriors();
	char *last = (char *)(&to.GetSpectralBand());
	const char *rest = (const char *)(&from.GetSpectralBand());
	memcpy(last, rest, (const char *)(&from + 1) - rest);
}

void Bent_Path::Begin(float weight)
{
	if(original.IsPhotonRay() || original.IsSubsurfaceRay())
		return;
	if(bent->depth == bent->pool.size())
		bent->pool.push_back(new Bent_Segment());
	state = bent->pool[bent->depth++];
	Bent_Segment& s = *state;
	Copy(s.chord, original);
	s.has_tangent = s.captured = s.moved = false;
	s.travelled = 0.0;
	s.chords = 0;
	s.weight = weight;
	s.drift = 0.0;
	s.end = "";
	s.spans.clear();
	Set_Volume();
	if(bent->recorder != NULL)
	{
		s.record = bent->recorder->rays.size();
		bent->recorder->rays.push_back(Recorded_Ray());
		bent->recorder->rays.back().Level = (unsigned int)bent->depth;
		bent->recorder->rays.back().End = "max trace level";
		bent->recorder->rays.back().Drift = 0.0;
	}
}

void Bent_Path::End()
{
	if(bent->recorder != NULL)
	{
		bent->recorder->rays[state->record].Drift = state->drift;
		if(*state->end != 0)
			bent->recorder->rays[state->record].End = state->end;
	}
	bent->depth--;
}

const Ray& Bent_Path::Bent_Chord() const
{
	return state->chord;
}

bool Bent_Path::Bent_Captured() const
{
	return state->captured;
}

DBL Bent_Path::Bent_Travelled() const
{
	return state->travelled;
}

// No light comes from there.
bool Bent_Path::Swallowed(Intersection& isect)
{
	bent->counts.Captured++;
	state->captured = true;
	isect.Depth = 0.0;
	return End_With("horizon", false);
}

bool Bent_Path::End_With(const char *end, bool found)
{
	state->end = end;
	bent->counts.Most_Chords = max(bent->counts.Most_Chords, state->chords);
	return found;
}

// The coordinate direction in which the ray leaves its origin. False if no light comes from there.
bool Bent_Path::Enter(VECTOR origin, Vec3& direction)
{
	// Not a bit is changed of a ray that goes straight.
	direction = Vec3_Of(original.Direction);
	if(fabs(dot(direction, direction) - 1.0) > 1e-12)
		direction = unit(direction);
	Assign_Vector(origin, original.Origin);
	const Blackhole *falling = bent->holes.Falling();
	if(original.IsPrimaryRay() && (falling != NULL))
	{
		const Vec3 x = falling->To_Hole(origin);
		if(dot(x, x) == 0.0)
		{
			bent->counts.Origins_Inside++;
			return false;
		}
		return falling_to_coordinate(x, direction, falling->Rim(), direction);
	}
	const Blackhole *hole = bent->holes.At(origin);
	if(hole == NULL)
		return true;
	const Vec3 x = hole->To_Hole(origin);
	if(length(x) <= 1.0)
	{
		bent->counts.Origins_Inside++;
		return false;
	}
	if(!original.IsPrimaryRay() || (hole->Camera != Blackhole::COORDINATE_CAMERA))
		direction = static_to_coordinate(x, direction, hole->Rim());
	return true;
}

// The next effect sphere on a straight way, other than the one just left.
size_t Bent_Path::Next_Sphere(const VECTOR from, const Vec3& direction, size_t left, DBL& distance) const
{
	size_t next = NO_HOLE;
	const std::vector<Blackhole *>& holes = bent->holes.Holes();
	for(size_t i = 0; i < holes.size(); i++)
	{
		if(i == left)
			continue;
		const Vec3 x = Vec3_Of(from) - Vec3_Of(holes[i]->Center);
		const DBL R = holes[i]->Reach(), b = dot(x, direction), c = dot(x, x) - R * R;
		if((c < 0.0) && (next == NO_HOLE || distance > 0.0))
		{
			next = i;
			distance = 0.0;
		}
		const DBL square = b * b - c;
		if((b >= 0.0) || (square <= 0.0) || (c < 0.0))
			continue;
		const DBL t = c / (-b + sqrt(square));
		if((next == NO_HOLE) || (t < distance))
		{
			next = i;
			distance = t;
		}
	}
	return next;
}

bool Bent_Path::Find_Intersection(Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	s.budget = isect.Depth < BOUND_HUGE ? isect.Depth : HUGE_VAL;
	const bool sky = bent->holes.Only_Sky() && !volume && (bent->recorder == NULL) && (s.budget == HUGE_VAL);
	const bool found = sky ? To_Sky(isect) : Follow(isect, pre, post);
	if((bent->ends != NULL) && !original.IsPretraceRay())
	{
		const Vec3 nowhere = { 0.0, 0.0, 0.0 };
		const Ray_End end = { (unsigned int)bent->depth, state->weight, state->end, found ? isect.Object : NULL,
		                      found ? Vec3_Of(isect.IPoint) : state->captured ? nowhere : Vec3_Of(state->chord.Direction) };
		bent->ends->rays.push_back(end);
	}
	return found;
}

bool Bent_Path::Follow(Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	VECTOR at;
	Vec3 direction;
	if(!Enter(at, direction))
	{
		bent->counts.Entered++;
		return Swallowed(isect);
	}
	size_t left = NO_HOLE;
	for(int passages = 0; passages < MOST_PASSAGES; passages++)
	{
		DBL distance = 0.0;
		const size_t next = Next_Sphere(at, direction, left, distance);
		const DBL remains = s.budget - s.travelled;
		if((next == NO_HOLE) || (distance > 0.0))
		{
			const bool last = (next == NO_HOLE) || (distance >= remains);
			if(Straight(at, direction, last ? min(remains, BOUND_HUGE) : distance, isect, pre, post))
				return End_With("object", true);
			if(last)
				return End_With(s.budget < BOUND_HUGE ? "max distance" : "sky", false);
			Pass(at, direction, distance);
			VEvaluateRay(at, at, distance, s.chord.Direction);
		}
		if(Through(next, at, direction, isect, pre, post))
			return End_With("object", true);
		if(s.captured || (*s.end != 0))
			return End_With(s.captured ? "horizon" : s.end, false);
		left = next;
	}
	s.captured = true;
	bent->counts.Trapped++;
	return End_With("horizon", false);
}

}
