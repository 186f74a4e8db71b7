// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <typeinfo>

#include <cxxabi.h>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/lighting/point.h"
#include "backend/math/vector.h"
#include "backend/render/ray.h"
#include "backend/scene/objects.h"
#include "backend/shape/blob.h"
#include "backend/shape/csg.h"
#include "backend/shape/fpmetric.h"
#include "backend/shape/isosurf.h"
#include "backend/shape/planes.h"
#include "backend/shape/spheres.h"
#include "backend/shape/sphsweep.h"
#include "backend/blackhole/reach.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

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

// The nearest and farthest an object's bounding box comes to the hole's centre, in Schwarzschild radii.
void Radii(const ObjectBase& object, const Blackhole& hole, DBL& nearest, DBL& farthest)
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
		// POV-Ray takes negative radii, for what they are without the sign.
		const DBL distance = hole.Distance(sphere->Center), radius = fabs(sphere->Radius);
		nearest = fabs(distance - radius) / hole.Radius - 1e-9 * (distance + radius) / hole.Radius;
		farthest = (distance + radius) / hole.Radius * (1.0 + 1e-9);
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

// The most that an object or any of its parts has of something, scene units; stretch: no direction of its own space is
// stretched by more.
static DBL Most_Of(const ObjectBase& object, DBL (*own)(const ObjectBase&, DBL stretch))
{
	DBL square = 1.0;
	if(object.Trans != NULL)
	{
		square = 0.0;
		for(int i = 0; i < 3; i++)
			for(int j = 0; j < 3; j++)
				square += Sqr(object.Trans->matrix[i][j]);
	}
	DBL most = own(object, sqrt(square));
	const CompoundObject *compound = dynamic_cast<const CompoundObject *>(&object);
	if(compound != NULL)
		for(size_t i = 0; i < compound->children.size(); i++)
			most = max(most, Most_Of(*compound->children[i], own));
	return most;
}

// What is found by search is found to within this, and more than once from different starts; all else has roots. An
// isosurface's accuracy is in scene units, a parametric surface's in its parameters, as a part of its size.
static DBL Own_Vagueness(const ObjectBase& object, DBL stretch)
{
	if(const IsoSurface *iso = dynamic_cast<const IsoSurface *>(&object))
		return 2.0 * iso->accuracy;
	if(const Parametric *parametric = dynamic_cast<const Parametric *>(&object))
		return parametric->accuracy * max(object.BBox.Lengths[X], max(object.BBox.Lengths[Y], object.BBox.Lengths[Z]));
	if(const SphereSweep *sweep = dynamic_cast<const SphereSweep *>(&object))
		return 2.0 * sweep->Depth_Tolerance * max(1.0, stretch);
	return 0.0;
}

// The shapes' own DEPTH_TOLERANCE: none exceeds 1e-4, but for blobs. Some mean their own units, some the scene's. An isosurface
// takes what is within a few times its accuracy for the surface it starts from.
static DBL Own_Blindness(const ObjectBase& object, DBL stretch)
{
	const DBL depth = (dynamic_cast<const Blob *>(&object) != NULL ? 1e-2 : 1e-4) * max(1.0, stretch);
	return max(dynamic_cast<const IsoSurface *>(&object) != NULL ? MIN_ISECT_DEPTH : depth, 5.0 * Own_Vagueness(object, stretch));
}

DBL Blind_Depth(const ObjectBase& object)
{
	return Most_Of(object, Own_Blindness);
}

DBL Vague_Depth(const ObjectBase& object)
{
	return Most_Of(object, Own_Vagueness);
}

std::string Object_Name(const ObjectBase& object)
{
	char text[128];
	snprintf(text, sizeof text, "the one bounded by <%g,%g,%g>, <%g,%g,%g>", object.BBox.Lower_Left[X], object.BBox.Lower_Left[Y], object.BBox.Lower_Left[Z],
	         object.BBox.Lower_Left[X] + object.BBox.Lengths[X], object.BBox.Lower_Left[Y] + object.BBox.Lengths[Y], object.BBox.Lower_Left[Z] + object.BBox.Lengths[Z]);
	return text;
}

// Whether a ray can hit it at all: light sources are objects too, but only what they look like is seen.
bool Visible(const ObjectBase& object)
{
	const LightSource *light = dynamic_cast<const LightSource *>(&object);
	return (light == NULL) || !light->children.empty();
}

// Whether some of the object's surface is inside the horizon: tried with chords across it, since a bounding box says little
// of a ring around the hole.
bool Pierces_Horizon(ObjectPtr object, const Blackhole& hole, TraceThreadData *thread)
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
std::string Kind(const ObjectBase& object)
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
std::string Listed(const std::map<std::string, unsigned int>& kinds)
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

}
