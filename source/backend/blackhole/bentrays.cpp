// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/scene.h"
#include "backend/blackhole/bentrays.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/blackholes.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::Vec3;

Bent_Rays *Bent_Rays::Create(const SceneData& scene, Trace& trace)
{
	if((scene.blackHoles == NULL) || !scene.blackHoles->Active())
		return NULL;
	return new Bent_Rays(scene, trace);
}

Bent_Rays::Bent_Rays(const SceneData& s, Trace& t) :
	scene(s), holes(*s.blackHoles), trace(t), counts(*s.blackHoles->New_Counts()), depth(0),
	fills((s.fog != NULL) || (s.rainbow != NULL) || !s.atmosphere.empty()),
	keeps((holes.Paths() != NULL) || (holes.Ends() != NULL)), recorder(NULL), ends(NULL)
{
}

Bent_Rays::~Bent_Rays()
{
	for(size_t i = 0; i < pool.size(); i++)
		delete pool[i];
	delete recorder;
	delete ends;
}

void Bent_Rays::Begin(DBL x, DBL y, DBL width, DBL height)
{
	if(holes.Ends() != NULL)
	{
		ends = new End_Recorder();
		ends->x = int(floor(x));
		ends->y = int(floor(y));
	}
	if((holes.Paths() == NULL) || !holes.Paths()->Wants(x, y, width, height))
		return;
	recorder = new Recorder();
	recorder->x = int(floor(x));
	recorder->y = int(floor(y));
}

void Bent_Rays::End()
{
	if(ends != NULL)
	{
		holes.Ends()->Keep(ends->x, ends->y, ends->rays);
		delete ends;
		ends = NULL;
	}
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
	const DBL R = hole->Rim();
	Assign_Vec3(ray.Direction, to_static ? coordinate_to_static(x, d, R) : static_to_coordinate(x, d, R));
}

const Bent_Segment *Bent_Rays::Shaded(const Ray& ray) const
{
	return (depth > 0) && (&pool[depth - 1]->chord == &ray) ? pool[depth - 1] : NULL;
}

}
