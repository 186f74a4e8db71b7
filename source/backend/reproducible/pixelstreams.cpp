// SPDX-License-Identifier: AGPL-3.0-or-later
// What a thread would carry from one camera ray to the next: random numbers, and what it remembers to be quicker.
#include <algorithm>
#include <cstring>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/scene/view.h"
#include "backend/scene/threaddata.h"
#include "backend/interior/media.h"
#include "backend/lighting/radiosity.h"
#include "backend/support/octree.h"
#include "backend/reproducible/reproducible.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

// Steele, Lea and Flood, "Fast splittable pseudorandom number generators" (2014): the mixing step of SplitMix64.
static POV_ULONG Mixed(POV_ULONG z)
{
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
	return z ^ (z >> 31);
}

static POV_ULONG Bits(DBL value)
{
	POV_ULONG bits;
	value += 0.0; // -0 is 0
	memcpy(&bits, &value, sizeof(bits));
	return bits;
}

template<class Type>
static void Seed_Each(std::vector<shared_ptr<SequentialNumberGenerator<Type> > >& generators, POV_ULONG seed)
{
	for(size_t i = 0; i < generators.size(); i++)
		if(SeedableNumberGenerator<Type> *g = dynamic_cast<SeedableNumberGenerator<Type> *>(generators[i].get()))
			g->Seed(Mixed(seed + i));
}

void Reproducible::Begin(Trace& trace, DBL x, DBL y, bool moves, bool& interiors) const
{
	RadiosityFunction *radiosity = dynamic_cast<RadiosityFunction *>(&trace.radiosity);
	// The pretrace is one thread's, all of it: its samples are the better for going on.
	if((radiosity != NULL) && !radiosity->isFinalTrace)
		return;

	const POV_ULONG seed = Mixed(Bits(x) + 0x9e3779b97f4a7c15ULL * Mixed(Bits(y)));
	Seed(trace, trace.media, seed);
	if((radiosity != NULL) && trace.sceneData->radiositySettings.radiosityEnabled)
	{
		Seed(radiosity->trace, radiosity->media, Mixed(seed));
		// What a pixel gathers because the pretrace left nothing near it looks into the same directions as its neighbour: no noise.
		struct Opened : RadiosityFunction::SampleDirectionGenerator
		{
			static SequentialNumberGenerator<Vector3d> *Directions(SampleDirectionGenerator& g) { return (g.*&Opened::sampleDirections).get(); }
		};
		for(int depth = 0; depth < radiosity->settings.recursionLimit; depth++)
			if(SeedableNumberGenerator<Vector3d> *g = dynamic_cast<SeedableNumberGenerator<Vector3d> *>(Opened::Directions(radiosity->recursionParameters[depth].directionGenerator)))
				g->Seed(0);
	}
	// A perspective camera's origin is the same for all, other cameras that move look around by themselves.
	interiors = interiors || moves;
}

void Reproducible::Seed(Trace& trace, Trace::MediaFunctor& media, POV_ULONG seed)
{
	trace.randomNumberGenerator.SetSeed(seed);
	trace.crandRandomNumberGenerator = seed >> 20;
	static_cast<MediaFunction&>(media).randomNumberGenerator.SetSeed(seed >> 40);
	if(trace.sceneData->useSubsurface)
	{
		// As deep as subsurface light goes; made now, not when first needed, so that the first pixel is like the others.
		while(trace.ssltUniformDirectionGenerator.size() < 3)
		{
			trace.ssltUniformDirectionGenerator.push_back(GetSubRandomDirectionGenerator(0, 32767));
			trace.ssltUniformNumberGenerator.push_back(GetRandomDoubleGenerator(0.0, 1.0, 32767));
		}
		Seed_Each(trace.ssltUniformDirectionGenerator, seed);
		Seed_Each(trace.ssltUniformNumberGenerator, seed + 1000);
	}
	// The object that was last in a light's way is tried first; where it is, glass and media before it are not looked at.
	std::fill(trace.lightSourceLevel1ShadowCache.begin(), trace.lightSourceLevel1ShadowCache.end(), ObjectPtr(NULL));
	std::fill(trace.lightSourceOtherShadowCache.begin(), trace.lightSourceOtherShadowCache.end(), ObjectPtr(NULL));
	// Facets remember a cube by a hash that other cubes share.
	trace.threadData->Facets_Last_Seed = 0x80000000;
}

bool Reproducible::Keeps_Samples(const Trace& trace, unsigned int pass)
{
	return (pass != OT_PASS_FINAL) || !trace.sceneData->reproducible;
}

}
