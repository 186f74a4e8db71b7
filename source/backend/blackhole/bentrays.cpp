// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/bounding/bbox.h"
#include "backend/interior/interior.h"
#include "backend/render/trace.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/blackhole/bentrays.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/raypaths.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::Vec3;

// POV-Ray drops hits nearer than MIN_ISECT_DEPTH to a ray's start. Chords after the first start this much early,
// and accept what lies beyond the joint (less a little, so that rounding on both sides leaves no gap).
static const DBL BACK_UP = 2.0 * MIN_ISECT_DEPTH;
static const DBL JOINT = 0.9 * BACK_UP;

// The least depth a hit on a chord may have: beyond the joint, and as far from the ray's own origin as POV-Ray wants it.
// (Chords may be shorter than MIN_ISECT_DEPTH; the second then starts behind the surface the ray has just left.)
static DBL Least_Depth(bool moved, DBL travelled)
{
	return moved ? max(JOINT, BACK_UP + MIN_ISECT_DEPTH - travelled) : 0.0;
}

// A ray may be passed from hole to hole; light that never leaves is as good as captured.
static const int MOST_PASSAGES = 1000;

static const size_t NO_HOLE = size_t(-1);

struct Recorder
{
	int x, y;
	Recorded_Pixel rays;
};

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
			if(hole->Distance(p) <= hole->Radius)
				return false;
		}
		return condition(ray, object, depth);
	}
	const RayObjectCondition& condition;
	DBL least;
	const Blackhole *hole;
};

Bent_Rays *Bent_Rays::Create(const SceneData& scene, Trace& trace)
{
	if((scene.blackHoles == NULL) || !scene.blackHoles->Active())
		return NULL;
	return new Bent_Rays(scene, trace);
}

Bent_Rays::Bent_Rays(const SceneData& s, Trace& t) :
	scene(s), holes(*s.blackHoles), trace(t), counts(*s.blackHoles->New_Counts()), depth(0), recorder(NULL)
{
}

Bent_Rays::~Bent_Rays()
{
	for(size_t i = 0; i < pool.size(); i++)
		delete pool[i];
	delete recorder;
}

void Bent_Rays::Begin(DBL x, DBL y, DBL width, DBL height)
{
	if((holes.Paths() == NULL) || !holes.Paths()->Wants(x, y, width, height))
		return;
	recorder = new Recorder();
	recorder->x = int(x);
	recorder->y = int(y);
}

void Bent_Rays::End()
{
	if(recorder == NULL)
		return;
	holes.Paths()->Keep(recorder->x, recorder->y, recorder->rays);
	delete recorder;
	recorder = NULL;
}

bool Bent_Rays::Blocks_Light(const Ray& ray, DBL length) const
{
	for(size_t i = 0; i < holes.Holes().size(); i++)
		if(holes.Holes()[i]->Blocks(ray.Origin, ray.Direction, length))
			return true;
	return false;
}

void Bent_Rays::Turn(Ray& ray, bool to_static) const
{
	const Blackhole *hole = holes.At(ray.Origin);
	if(hole == NULL)
		return;
	const Vec3 x = hole->To_Hole(ray.Origin), d = Vec3_Of(ray.Direction);
	const DBL R = hole->Settings().effect_radius;
	Assign_Vec3(ray.Direction, to_static ? coordinate_to_static(x, d, R) : static_to_coordinate(x, d, R));
}

const Bent_Segment *Bent_Rays::Shaded(const Ray& ray) const
{
	return (depth > 0) && (&pool[depth - 1]->chord == &ray) ? pool[depth - 1] : NULL;
}

void Bent_Path::Begin()
{
	if(original.IsPhotonRay() || original.IsSubsurfaceRay())
		return;
	if(bent->depth == bent->pool.size())
		bent->pool.push_back(new Bent_Segment());
	state = bent->pool[bent->depth++];
	Bent_Segment& s = *state;
	s.chord = original;
	s.has_tangent = s.captured = s.moved = false;
	s.travelled = 0.0;
	s.chords = 0;
	s.drift = 0.0;
	s.end = "";
	s.spans.clear();
	const SceneData& scene = bent->scene;
	s.volume = (scene.fog != NULL) || !scene.atmosphere.empty() || !original.GetInteriors().empty();
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

bool Bent_Path::End_With(const char *end, bool found)
{
	state->end = end;
	bent->counts.Most_Chords = max(bent->counts.Most_Chords, state->chords);
	return found;
}

void Bent_Path::Record(const VECTOR from, const VECTOR to, size_t hole, bool tested)
{
	if(bent->recorder == NULL)
		return;
	Recorded_Ray::Chord c = { Vec3_Of(from), Vec3_Of(to), hole == NO_HOLE ? -1 : int(hole), tested };
	bent->recorder->rays[state->record].Chords.push_back(c);
}

// The coordinate direction in which the ray leaves its origin. False if no light comes from there.
bool Bent_Path::Enter(VECTOR origin, Vec3& direction)
{
	direction = unit(Vec3_Of(original.Direction));
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
		return falling_to_coordinate(x, direction, falling->Settings().effect_radius, direction);
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
		direction = static_to_coordinate(x, direction, hole->Settings().effect_radius);
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
	VECTOR at;
	Vec3 direction;
	s.budget = isect.Depth;
	if(!Enter(at, direction))
	{
		s.captured = true;
		bent->counts.Captured++;
		return End_With("horizon", false);
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
			if(Straight(at, direction, last ? remains : distance, isect, pre, post))
				return End_With("object", true);
			if(last)
				return End_With(s.budget < BOUND_HUGE ? "max distance" : "sky", false);
			VEvaluateRay(at, at, distance, s.chord.Direction);
		}
		if(Through(next, at, direction, isect, pre, post))
			return End_With("object", true);
		if(s.captured || (*s.end != 0))
			return End_With(s.captured ? "horizon" : s.end, false);
		left = next;
	}
	s.captured = true;
	return End_With("horizon", false);
}

// A leg outside all spheres, of the length given.
bool Bent_Path::Straight(const VECTOR from, const Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const DBL back = s.moved ? BACK_UP : 0.0;
	Assign_Vec3(s.chord.Direction, direction);
	VEvaluateRay(s.chord.Origin, from, -back, s.chord.Direction);
	isect.Depth = length + back;
	const Chord_Condition condition(post, Least_Depth(s.moved, s.travelled), NULL);
	const bool found = bent->trace.FindIntersection(isect, s.chord, pre, condition);
	Assign_Vector(s.chord.Origin, from);
	isect.Depth = max(0.0, isect.Depth - back);
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
	if(!found && (length < s.budget - s.travelled))
	{
		if(s.volume)
		{
			Bent_Segment::Span span;
			Assign_Vector(span.from, from);
			Assign_Vec3(span.direction, direction);
			span.length = length;
			s.spans.push_back(span);
		}
		s.travelled += length;
	}
	return found;
}

// Through one effect sphere. On true the chord in hand hit something; otherwise from and direction are where the
// ray left the sphere, unless it was captured or ended (state->end).
bool Bent_Path::Through(size_t index, VECTOR from, Vec3& direction, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	Bent_Segment& s = *state;
	const Blackhole& hole = *bent->holes.Holes()[index];
	const Shells& shells = bent->holes.Shells_Of(index);
	Blackhole_Counts& counts = bent->counts;
	blackhole::Path& path = bent->path;
	const bool solved = path.solve(hole.To_Hole(from), direction, hole.Settings());

	counts.Entered++;
	counts.Nudged += path.nudged();
	counts.Failed += !solved;
	counts.Most_Swept = max(counts.Most_Swept, path.swept());
	s.drift = max(s.drift, path.drift());
	if(path.outcome() == blackhole::Outcome::captured)
		counts.Captured++;
	if(!path.nudged())
		counts.Drift = max(counts.Drift, path.drift());

	if(!shells.Empty() || s.volume || (bent->recorder != NULL) || (s.budget < BOUND_HUGE))
	{
		blackhole::Chords chords(path, hole.Tolerance, !s.moved && !original.IsPrimaryRay());
		blackhole::Chord c;
		bool first = path.started_inside();
		while(chords.next(c))
		{
			VECTOR start, end;
			hole.To_Scene(c.from, start);
			hole.To_Scene(c.to, end);
			if(first)
				Emerge(start);
			first = false;
			Vec3 along = Vec3_Of(end) - Vec3_Of(start);
			const DBL chord_length = length(along);
			if(chord_length == 0.0)
				continue;
			along = (1.0 / chord_length) * along;
			Assign_Vec3(s.chord.Direction, along);
			Assign_Vector(s.chord.Origin, start);
			counts.Chords++;
			s.chords++;
			const bool test = shells.Overlap(c.nearest, c.farthest);
			const DBL remains = s.budget - s.travelled;
			isect.Depth = min(chord_length, remains);
			bool found = false;
			if(test)
			{
				counts.Tested++;
				const DBL back = s.moved ? BACK_UP : 0.0;
				VEvaluateRay(s.chord.Origin, start, -back, s.chord.Direction);
				isect.Depth += back;
				const Chord_Condition condition(post, Least_Depth(s.moved, s.travelled), c.nearest <= 1.0 + 1e-9 || c.nearest * hole.Radius - hole.Radius < BACK_UP ? &hole : NULL);
				found = bent->trace.FindIntersection(isect, s.chord, pre, condition);
				Assign_Vector(s.chord.Origin, start);
				isect.Depth = max(0.0, isect.Depth - back);
			}
			else
				counts.Skipped++;
			s.moved = true;
			if(found)
			{
				// The quadratic through both tangents whose mean is the chord.
				const DBL t = min(1.0, isect.Depth / chord_length);
				s.tangent = unit((1.0 - 4.0 * t + 3.0 * t * t) * c.tangent_from + (3.0 * t * t - 2.0 * t) * c.tangent_to + (6.0 * t - 6.0 * t * t) * along);
				s.has_tangent = true;
				Record(start, isect.IPoint, index, test);
				return true;
			}
			Record(start, end, index, test);
			if(chord_length >= remains)
			{
				s.end = "max distance";
				return false;
			}
			if(s.volume)
			{
				Bent_Segment::Span span;
				Assign_Vector(span.from, start);
				Assign_Vector(span.direction, s.chord.Direction);
				span.length = chord_length;
				s.spans.push_back(span);
			}
			s.travelled += chord_length;
		}
	}
	s.moved = true;
	if(path.outcome() == blackhole::Outcome::captured)
	{
		s.captured = true;
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
	state->volume = state->volume || !state->chord.GetInteriors().empty();
}

void Bent_Path::Bent_Volume(Colour& colour, Trace::TraceTicket& ticket)
{
	if(state->spans.empty())
		return;
	Trace& trace = bent->trace;
	const SceneData& scene = bent->scene;
	Ray& ray = state->chord;
	if(!(trace.qualityFlags & Q_VOLUME) || !ray.IsHollowRay())
		return;
	for(size_t i = state->spans.size(); i-- > 0; )
	{
		const Bent_Segment::Span& span = state->spans[i];
		Assign_Vector(ray.Origin, span.from);
		Assign_Vector(ray.Direction, span.direction);
		Intersection isect;
		isect.Depth = span.length;
		VEvaluateRay(isect.IPoint, span.from, span.length, span.direction);
		if(!ray.GetInteriors().empty())
			trace.media.ComputeMedia(ray.GetInteriors(), ray, isect, colour, ticket);
		trace.media.ComputeMedia(const_cast<vector<Media>&>(scene.atmosphere), ray, isect, colour, ticket);
		if(scene.fog != NULL)
			trace.ComputeFog(ray, isect, colour);
	}
}

}
