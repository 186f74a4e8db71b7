// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
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
#include "backend/blackhole/raypaths.h"
#include "backend/blackhole/reach.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

Blackhole_Counts::Blackhole_Counts() :
	Entered(0), Captured(0), Chords(0), Tested(0), Skipped(0), Nudged(0), Failed(0), Origins_Inside(0),
	Most_Chords(0), Most_Swept(0.0), Drift(0.0)
{
}

void Blackhole_Counts::Add(const Blackhole_Counts& other)
{
	Entered += other.Entered;
	Captured += other.Captured;
	Chords += other.Chords;
	Tested += other.Tested;
	Skipped += other.Skipped;
	Nudged += other.Nudged;
	Failed += other.Failed;
	Origins_Inside += other.Origins_Inside;
	Most_Chords = max(Most_Chords, other.Most_Chords);
	Most_Swept = max(Most_Swept, other.Most_Swept);
	Drift = max(Drift, other.Drift);
}

Blackholes::Blackholes(POVMS_Object& options) :
	enabled(options.TryGetBool(kPOVAttrib_Blackhole, true)),
	blind(MIN_ISECT_DEPTH),
	vague(0.0),
	far_objects(false),
	falling(NULL),
	paths(Ray_Paths::Create(options))
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
	return !holes.empty() || (paths != NULL);
}

std::string Blackholes::Prepare(const SceneData& scene, TraceThreadData *thread, MessageFactory& messages)
{
	std::string report;
	char text[512];
	shells.assign(holes.size(), Shells());
	for(size_t i = 0; i < scene.objects.size(); i++)
		if(Visible(*scene.objects[i]))
		{
			blind = max(blind, Blind_Depth(*scene.objects[i]));
			vague = max(vague, Vague_Depth(*scene.objects[i]));
		}
	tree.Build(scene.objects, MIN_ISECT_DEPTH + vague);
	for(size_t h = 0; h < holes.size(); h++)
		radii.push_back(tree.Radii_Around(*holes[h]));
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
		if(straddling > 0)
			messages.Warning(1, "%u object(s) reach into the horizon of the black hole at <%g,%g,%g> and exist outside it only; first: %s.",
			                 straddling, hole.Center[X], hole.Center[Y], hole.Center[Z], first.c_str());
	}
	return report;
}

const Blackhole *Blackholes::At(const VECTOR p) const
{
	for(size_t i = 0; i < holes.size(); i++)
		if(holes[i]->Distance(p) < holes[i]->Reach())
			return holes[i];
	return NULL;
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
	const Blackhole_Counts c = Sum();
	const double entered = max(1.0, double(c.Entered));
	char text[1024];
	snprintf(text, sizeof text,
	         "Bent Rays:          %15.0f   Captured:        %15.0f\n"
	         "Chords:             %15.0f   Per Ray:         %15.2f (most %u)\n"
	         "Chords Tested:      %15.0f   Skipped:         %15.0f\n"
	         "Most Turns:         %15.2f   Largest Drift:   %15.2g\n",
	         double(c.Entered), double(c.Captured), double(c.Chords), double(c.Chords) / entered, c.Most_Chords,
	         double(c.Tested), double(c.Skipped), c.Most_Swept / (2.0 * M_PI), c.Drift);
	std::string lines(text);
	if(c.Nudged > 0)
	{
		snprintf(text, sizeof text, "Beside Critical b:  %15.0f\n", double(c.Nudged));
		lines += text;
	}
	stats.SetString(kPOVAttrib_BlackholeStatistics, lines.c_str());
}

void Blackholes::Finish(MessageFactory& messages)
{
	const Blackhole_Counts c = Sum();
	if(c.Failed > 0)
		messages.Warning(1, "%.0f bent ray(s) could not be followed to the end (their b is within rounding of the critical one); they show the sky in their last direction.", double(c.Failed));
	if(c.Origins_Inside > 0)
		messages.Warning(1, "%.0f camera ray(s) started at or inside the horizon, where no static observer is; they are black. camera \"falling\" can look from there.", double(c.Origins_Inside));
	if(paths != NULL)
		paths->Write(*this, messages);
}

}
