// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <typeinfo>

#include <cxxabi.h>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/bounding/bbox.h"
#include "backend/control/messagefactory.h"
#include "backend/lighting/point.h"
#include "backend/math/vector.h"
#include "backend/render/ray.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/shape/planes.h"
#include "backend/shape/spheres.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/options.h"
#include "backend/blackhole/raypaths.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

Blackhole_Counts::Blackhole_Counts() :
	Rays(0), Entered(0), Captured(0), Chords(0), Tested(0), Skipped(0), Nudged(0), Failed(0), Origins_Inside(0),
	Most_Chords(0), Most_Swept(0.0), Drift(0.0)
{
}

void Blackhole_Counts::Add(const Blackhole_Counts& other)
{
	Rays += other.Rays;
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

void Shells::Add(DBL from, DBL to)
{
	shells.push_back(std::make_pair(from, to));
}

void Shells::Merge()
{
	std::sort(shells.begin(), shells.end());
	std::vector<std::pair<DBL, DBL> > merged;
	for(size_t i = 0; i < shells.size(); i++)
	{
		if(!merged.empty() && (shells[i].first <= merged.back().second))
			merged.back().second = max(merged.back().second, shells[i].second);
		else
			merged.push_back(shells[i]);
	}
	shells.swap(merged);
}

bool Shells::Overlap(DBL nearest, DBL farthest) const
{
	// the last shell that begins at or before the farthest point
	std::vector<std::pair<DBL, DBL> >::const_iterator i =
		std::upper_bound(shells.begin(), shells.end(), std::make_pair(farthest, std::numeric_limits<DBL>::infinity()));
	return (i != shells.begin()) && ((--i)->second >= nearest);
}

Blackholes::Blackholes(POVMS_Object& options) :
	enabled(options.TryGetBool(kPOVAttrib_Blackhole, true)),
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

// The nearest and farthest an object's bounding box comes to the hole's centre, in Schwarzschild radii.
static void Radii(const ObjectBase& object, const Blackhole& hole, DBL& nearest, DBL& farthest)
{
	// A plane keeps its distance, and a sphere is where its surface is; of all else the box is known.
	const Plane *plane = dynamic_cast<const Plane *>(&object);
	if((plane != NULL) && (plane->Trans == NULL))
	{
		nearest = fabs(dot(Vec3_Of(plane->Normal_Vector), Vec3_Of(hole.Center)) + plane->Distance) / hole.Radius * (1.0 - 1e-9);
		farthest = std::numeric_limits<DBL>::infinity();
		return;
	}
	const Sphere *sphere = dynamic_cast<const Sphere *>(&object);
	if((sphere != NULL) && (sphere->Trans == NULL))
	{
		const DBL distance = hole.Distance(sphere->Center);
		nearest = fabs(distance - sphere->Radius) / hole.Radius - 1e-9 * (distance + sphere->Radius) / hole.Radius;
		farthest = (distance + sphere->Radius) / hole.Radius * (1.0 + 1e-9);
		return;
	}
	DBL near2 = 0.0, far2 = 0.0, size = 0.0;
	for(int i = X; i <= Z; i++)
	{
		const DBL lo = object.BBox.Lower_Left[i] - hole.Center[i], hi = lo + object.BBox.Lengths[i];
		const DBL n = lo > 0.0 ? lo : (hi < 0.0 ? -hi : 0.0), f = max(fabs(lo), fabs(hi));
		near2 += n * n;
		far2 += f * f;
		size = max(size, f + fabs(hole.Center[i]));
	}
	// bounding boxes are in single precision
	nearest = max(0.0, sqrt(near2) - 1e-6 * size) / hole.Radius;
	farthest = (sqrt(far2) + 1e-6 * size) / hole.Radius;
}

static std::string Object_Name(const ObjectBase& object)
{
	char text[128];
	snprintf(text, sizeof text, "the one bounded by <%g,%g,%g>, <%g,%g,%g>", object.BBox.Lower_Left[X], object.BBox.Lower_Left[Y], object.BBox.Lower_Left[Z],
	         object.BBox.Lower_Left[X] + object.BBox.Lengths[X], object.BBox.Lower_Left[Y] + object.BBox.Lengths[Y], object.BBox.Lower_Left[Z] + object.BBox.Lengths[Z]);
	return text;
}

// Whether a ray can hit it at all: light sources are objects too, but only what they look like is seen.
static bool Visible(const ObjectBase& object)
{
	const LightSource *light = dynamic_cast<const LightSource *>(&object);
	return (light == NULL) || !light->children.empty();
}

// Whether some of the object's surface is inside the horizon: tried with chords across it, since a bounding box says little
// of a ring around the hole.
static bool Pierces_Horizon(ObjectPtr object, const Blackhole& hole, TraceThreadData *thread)
{
	const int points = 256;
	for(int i = 0; i < points; i++)
	{
		blackhole::Vec3 ends[2];
		for(int k = 0; k < 2; k++)
		{
			// a spiral from pole to pole, each point with one far along it
			const int n = (i + 97 * k) % points;
			const DBL z = 1.0 - (2.0 * n + 1.0) / points, a = 2.399963 * n;
			const blackhole::Vec3 p = { sqrt(1.0 - z * z) * cos(a), sqrt(1.0 - z * z) * sin(a), z };
			ends[k] = p;
		}
		const blackhole::Vec3 along = ends[1] - ends[0];
		Ray ray(Ray::OtherRay);
		hole.To_Scene(ends[0], ray.Origin);
		Assign_Vec3(ray.Direction, unit(along));
		Intersection isect;
		if(Find_Intersection(&isect, object, ray, thread) && (isect.Depth <= length(along) * hole.Radius))
			return true;
	}
	return false;
}

// "sphere", "csgunion": an object's kind, by its class; good enough for a message.
static std::string Kind(const ObjectBase& object)
{
	int status;
	char *name = abi::__cxa_demangle(typeid(object).name(), NULL, NULL, &status);
	std::string kind(status == 0 ? name : "object");
	free(name);
	kind.erase(0, kind.rfind(':') + 1);
	std::transform(kind.begin(), kind.end(), kind.begin(), tolower);
	return kind;
}

// " (2 sphere, 1 plane)"
static std::string Listed(const std::map<std::string, unsigned int>& kinds)
{
	std::string list;
	char text[96];
	for(std::map<std::string, unsigned int>::const_iterator i = kinds.begin(); i != kinds.end(); ++i)
	{
		snprintf(text, sizeof text, "%s%u %.60s", list.empty() ? "" : ", ", i->second, i->first.c_str());
		list += text;
	}
	return list.empty() ? list : " (" + list + ")";
}

std::string Blackholes::Prepare(const SceneData& scene, TraceThreadData *thread, MessageFactory& messages)
{
	std::string report;
	char text[512];
	shells.assign(holes.size(), Shells());
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
	stats.SetString(kPOVAttrib_BlackholeStatistics, text);
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
