// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <map>


// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/control/messagefactory.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/options.h"
#include "backend/blackhole/rayends.h"
#include "backend/blackhole/raypaths.h"
#include "backend/blackhole/reach.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

Blackholes::Blackholes(POVMS_Object& options) :
	enabled(options.TryGetBool(kPOVAttrib_Blackhole, true)),
	overrides(options),
	blind(MIN_ISECT_DEPTH),
	vague(0.0),
	far_objects(false),
	falling(NULL),
	paths(Ray_Paths::Create(options)),
	ends(Ray_Ends::Create(options))
{
}

Blackholes::~Blackholes()
{
	for(size_t i = 0; i < holes.size(); i++)
		Destroy_Object(holes[i]);
	for(size_t i = 0; i < counts.size(); i++)
		delete counts[i];
}

void Blackholes::Add(Blackhole *hole)
{
	holes.push_back(hole);
	if(hole->Camera == Blackhole::FALLING_CAMERA)
		falling = hole;
}

const Blackhole *Blackholes::Overlapping(const Blackhole& hole) const
{
	for(size_t i = 0; i < holes.size(); i++)
		if(holes[i]->Distance(hole.Center) < holes[i]->Reach() + hole.Reach())
			return holes[i];
	return NULL;
}

bool Blackholes::Active() const
{
	return !holes.empty() || (paths != NULL) || (ends != NULL);
}

std::string Blackholes::Prepare(const SceneData& scene, TraceThreadData *thread, MessageFactory& messages)
{
	std::string report;
	char text[512];
	if(ends != NULL)
		ends->Number(scene.objects);
	shells.assign(holes.size(), Shells());
	for(size_t i = 0; i < scene.objects.size(); i++)
		if(Visible(*scene.objects[i]))
		{
			blind = max(blind, Blind_Depth(*scene.objects[i]));
			vague = max(vague, Vague_Depth(*scene.objects[i]));
		}
	tree.Build(scene.objects, MIN_ISECT_DEPTH + vague);
	std::vector<bool> inside(tree.Count(), false);
	for(size_t h = 0; h < holes.size(); h++)
	{
		radii.push_back(tree.Radii_Around(*holes[h]));
		few.push_back(Few_Objects(tree, radii[h], *holes[h]));
		atlases.push_back(blackhole::Atlas(holes[h]->Settings()));
		for(size_t i = 0; i < inside.size(); i++)
			inside[i] = inside[i] || (radii[h][i].second * holes[h]->Radius < holes[h]->Reach());
	}
	for(size_t i = 0; i < inside.size(); i++)
		if(!inside[i])
			outside.push_back((unsigned int)i);
	for(size_t h = 0; h < holes.size(); h++)
	{
		const Blackhole& hole = *holes[h];
		unsigned int visible = 0, reached = 0, straddling = 0;
		std::string first;
		std::map<std::string, unsigned int> kinds;
		for(size_t i = 0; i < scene.objects.size(); i++)
		{
			if(!Visible(*scene.objects[i]))
				continue;
			visible++;
			DBL nearest, farthest;
			Radii(*scene.objects[i], hole, nearest, farthest);
			if(nearest * hole.Radius >= hole.Reach())
				continue;
			reached++;
			kinds[Kind(*scene.objects[i])]++;
			shells[h].Add(nearest, farthest);
			if((nearest <= 1.0) && Pierces_Horizon(scene.objects[i], hole, thread) && (straddling++ == 0))
				first = Object_Name(*scene.objects[i]);
		}
		far_objects = far_objects || (reached < visible);
		shells[h].Merge();
		snprintf(text, sizeof text, "Black hole at <%g,%g,%g>: Rs %g, effect radius %g, tolerance %g, method %s; %s%u of %u objects within reach",
		         hole.Center[X], hole.Center[Y], hole.Center[Z], hole.Radius, hole.Reach(), hole.Tolerance,
		         blackhole::method_names[int(hole.Method)],
		         reached == 0 ? "only the sky remains: " : "", reached, visible);
		report += text + Listed(kinds) + (reached == 0 ? ", rays need no chords.\n" : ".\n");
		// POV-Ray's own constants, MIN_ISECT_DEPTH and MAX_DISTANCE, are lengths: 1e-4 and 1e7.
		if((reached > 0) && ((hole.Radius < 1e-3) || (hole.Radius > 1e5)))
			messages.Warning(1, "POV-Ray loses objects nearer than 1e-4 and farther than 1e7 units; around a black hole with a Schwarzschild radius of %g that shows. Scale the scene so that it is between 1e-3 and 1e5.", hole.Radius);
		// Chords' ends are scene coordinates: their last digits must be small beside the fifth of the tolerance that chords leave.
		const DBL digits = DBL_EPSILON / 2.0 * max(fabs(hole.Center[X]), max(fabs(hole.Center[Y]), fabs(hole.Center[Z]))) / hole.Radius;
		if((reached > 0) && (hole.Tolerance < 5.0 * digits))
			messages.Warning(1, "The black hole at <%g,%g,%g> is so far from the origin that coordinates are good to %.2g of its Schwarzschild radii: no method keeps tolerance %g there; %.1g can be kept. Move the scene towards the origin, or make it larger.",
			                 hole.Center[X], hole.Center[Y], hole.Center[Z], digits, hole.Tolerance, 5.0 * digits);
		// Where rays enter the sphere their last digits shift b, and what b is off by turns them 1000 / b_c times as much at the edge
		// of the 0.1 % band.
		const DBL rim = DBL_EPSILON / 2.0 * 385.0 * hole.Reach() / hole.Radius;
		if(hole.Tolerance < rim)
			messages.Warning(1, "The effect radius of the black hole at <%g,%g,%g>, %.2g Schwarzschild radii, is so large that coordinates out there do not tell where rays go to its tolerance, %g: they do to %.1g.",
			                 hole.Center[X], hole.Center[Y], hole.Center[Z], hole.Reach() / hole.Radius, hole.Tolerance, rim);
		if(straddling > 0)
			messages.Warning(1, "%u object(s) reach into the horizon of the black hole at <%g,%g,%g> and exist outside it only; first: %s.",
			                 straddling, hole.Center[X], hole.Center[Y], hole.Center[Z], first.c_str());
	}
	return report;
}

Blackhole_Counts *Blackholes::New_Counts()
{
	boost::mutex::scoped_lock lock(mutex);
	counts.push_back(new Blackhole_Counts());
	return counts.back();
}

Blackhole_Counts Blackholes::Sum()
{
	boost::mutex::scoped_lock lock(mutex);
	Blackhole_Counts sum;
	for(size_t i = 0; i < counts.size(); i++)
		sum.Add(*counts[i]);
	return sum;
}

void Blackholes::Get_Statistics(POVMS_Object& stats)
{
	if(holes.empty())
		return;
	stats.SetString(kPOVAttrib_BlackholeStatistics, Sum().Text(holes, shells).c_str());
}

void Blackholes::Finish(MessageFactory& messages)
{
	Sum().Warn(messages);
	if(paths != NULL)
		paths->Write(*this, messages);
	if(ends != NULL)
		ends->Write(*this, messages);
}

}
