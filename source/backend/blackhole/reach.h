// SPDX-License-Identifier: AGPL-3.0-or-later
/// What of a scene is within reach of a hole: at which radii something may be hit, and how to speak of it.
#ifndef POVRAY_BLACKHOLE_REACH_H
#define POVRAY_BLACKHOLE_REACH_H

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "backend/blackhole/blackhole.h"

namespace pov
{

/// The radii, in Schwarzschild radii, at which something of the scene may be hit around one hole.
class Shells
{
	public:
		void Add(DBL from, DBL to);
		void Merge();
		bool Empty() const { return shells.empty(); }
		bool Overlap(DBL nearest, DBL farthest) const;
		const std::vector<std::pair<DBL, DBL> >& List() const { return shells; }
	private:
		std::vector<std::pair<DBL, DBL> > shells;
};

/// The nearest and farthest an object comes to the hole's centre, in Schwarzschild radii; the farthest may be infinite.
void Radii(const ObjectBase& object, const Blackhole& hole, DBL& nearest, DBL& farthest);
/// The depth up to which its own code drops hits, scene units: what lies nearer to a ray's start is missed.
DBL Blind_Depth(const ObjectBase& object);
/// How far off a hit's depth may be, scene units: what one chord finds a little behind its end, the next may find before its start.
DBL Vague_Depth(const ObjectBase& object);
/// Whether a ray can hit it at all.
bool Visible(const ObjectBase& object);
/// Whether some of the object's surface is inside the horizon; tried with chords, so a speck may be missed.
bool Pierces_Horizon(ObjectPtr object, const Blackhole& hole, TraceThreadData *thread);

/// An object's kind, "sphere"; a list of kinds with their numbers, " (2 sphere, 1 plane)"; and an object by its bounds.
std::string Kind(const ObjectBase& object);
std::string Listed(const std::map<std::string, unsigned int>& kinds);
std::string Object_Name(const ObjectBase& object);

}

#endif
