// SPDX-License-Identifier: AGPL-3.0-or-later
/// What fills the space along a bent way: media, rainbow and fog, on every chord, back to front; also before a horizon.
///
/// Each effect goes over the whole way before the next one does, in TraceRay's order, so that a way of many chords
/// in one line looks as the line does.
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/interior/interior.h"
#include "backend/math/vector.h"
#include "backend/scene/atmosph.h"
#include "backend/scene/scene.h"
#include "backend/texture/texture.h"
#include "backend/blackhole/bentpath.h"
#include "backend/blackhole/bentsegment.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

// Whether there is anything along this ray's way: else no chord is kept for it.
void Bent_Path::Set_Volume()
{
	const RayInteriorVector& interiors = state->chord.GetInteriors();
	volume = bent->fills;
	for(RayInteriorVector::const_iterator i = interiors.begin(); (i != interiors.end()) && !volume; i++)
		volume = !(*i)->media.empty();
}

// Makes a span the chord in hand, from start to end.
void Bent_Path::Take(size_t index, Intersection& isect)
{
	const Bent_Segment::Span& span = state->spans[index];
	Assign_Vector(state->chord.Origin, span.from);
	Assign_Vector(state->chord.Direction, span.direction);
	isect.Depth = span.length;
	VEvaluateRay(isect.IPoint, span.from, span.length, span.direction);
}

void Bent_Path::Volume_Of(Intersection& isect, bool found, Colour& colour, Trace::TraceTicket& ticket)
{
	Bent_Segment& s = *state;
	Trace& trace = bent->trace;
	const SceneData& scene = bent->scene;
	if(!(trace.qualityFlags & Q_VOLUME) || !s.chord.IsHollowRay())
		return;
	const size_t last = s.spans.size();
	Bent_Segment::Span in_hand;
	Assign_Vector(in_hand.from, s.chord.Origin);
	Assign_Vector(in_hand.direction, s.chord.Direction);
	in_hand.length = isect.Depth;
	s.spans.push_back(in_hand);
	Intersection part;

	// ComputeTextureColour did the last chord's, if it hit. A ray that ends in the sky shows no interior, as in POV-Ray.
	if((found || s.captured) && !s.chord.GetInteriors().empty())
		for(size_t i = found ? last : last + 1; i-- > 0; )
			if(s.spans[i].length > 0.0)
			{
				Take(i, part);
				trace.media.ComputeMedia(s.chord.GetInteriors(), s.chord, part, colour, ticket);
			}
	if(scene.rainbow != NULL)
	{
		s.before = s.travelled;
		for(size_t i = last + 1; i-- > 0; )
		{
			// ComputeRainbow asks for the way before through the hook.
			Take(i, part);
			part.Depth += s.before;
			trace.ComputeRainbow(s.chord, part, colour);
			if(i > 0)
				s.before -= s.spans[i - 1].length;
		}
	}
	if(!scene.atmosphere.empty())
		for(size_t i = last + 1; i-- > 0; )
			if(s.spans[i].length > 0.0)
			{
				Take(i, part);
				trace.media.ComputeMedia(const_cast<vector<Media>&>(scene.atmosphere), s.chord, part, colour, ticket);
			}
	Take(last, part);
	s.spans.pop_back();
	if(scene.fog != NULL)
		trace.ComputeFog(s.chord, part, colour);
}

// A fog's turbulence thickens or thins the way as a whole, by its value half-way along.
DBL Bent_Path::Bent_Fog(const Bent_Rays& bent, const Ray& ray, DBL width, const FOG& fog, DBL att)
{
	const Bent_Segment *s = bent.Shaded(ray);
	if((s == NULL) || s->spans.empty())
		return att;
	Trace& trace = bent.trace;
	FOG still(fog);
	still.Turb = NULL;
	Ray part(ray);
	Colour ignored;
	VECTOR middle;
	DBL through = 1.0, length = width;
	for(size_t i = 0; i < s->spans.size(); i++)
		length += s->spans[i].length;
	DBL left = 0.5 * length;
	for(size_t i = 0; i <= s->spans.size(); i++)
	{
		const bool before = (i < s->spans.size());
		const DBL l = before ? s->spans[i].length : width;
		Assign_Vector(part.Origin, before ? s->spans[i].from : ray.Origin);
		Assign_Vector(part.Direction, before ? s->spans[i].direction : ray.Direction);
		through *= fog.Type == GROUND_MIST ? trace.ComputeGroundFogColour(part, 0.0, l, &still, ignored) :
		                                     trace.ComputeConstantFogColour(part, 0.0, l, &still, ignored);
		if((left >= 0.0) && (left <= l))
			VEvaluateRay(middle, part.Origin, left, part.Direction);
		left -= l;
	}
	if(fog.Turb == NULL)
		return through;
	VEvaluateEq(middle, fog.Turb->Turbulence);
	const DBL wind = min(1.0, Turbulence(middle, fog.Turb, bent.scene.noiseGenerator) * fog.Turb_Depth);
	return pow(through, 1.0 - exp(-length / fog.Distance) * wind);
}

DBL Bent_Path::Bent_Rainbow(const Bent_Rays& bent, const Ray& ray, DBL distance, DBL least)
{
	const Bent_Segment *s = bent.Shaded(ray);
	return (s == NULL) || (s->before <= 0.0) ? 1.0 : max(exp(-s->before / distance), least);
}

}
