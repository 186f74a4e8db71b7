// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/shape/csg.h"
#include "backend/shape/hfield.h"
#include "backend/shape/planes.h"
#include "backend/blackhole/solidbounds.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

void Scene_Box::Take(const ObjectBase& object, DBL margin)
{
	for(int i = 0; i < 3; i++)
	{
		// A sphere of negative radius has its box inside out.
		const DBL from = object.BBox.Lower_Left[i], to = from + object.BBox.Lengths[i], more = margin + 1e-6 * max(fabs(from), fabs(to));
		lo[i] = min(from, to) - more;
		hi[i] = max(from, to) + more;
	}
}

bool Scene_Box::Meets(const Scene_Chord& c) const
{
	DBL in = 0.0, out = 1.0;
	for(int i = 0; i < 3; i++)
	{
		const DBL d = c.to[i] - c.from[i], near_side = lo[i] - c.bulge - c.from[i], far_side = hi[i] + c.bulge - c.from[i];
		if((max(d, 0.0) < near_side) || (min(d, 0.0) > far_side))
			return false;
		if(fabs(d) < 1e-30)
			continue;
		const DBL per = 1.0 / d, a = near_side * per, b = far_side * per;
		in = max(in, min(a, b));
		out = min(out, max(a, b));
		if(in > out)
			return false;
	}
	return true;
}

Solid_Bounds::Solid_Bounds(const ObjectBase& object, DBL m) : margin(m)
{
	Add(object, false);
}

// part: of an intersection, where all of the solid counts, not its surface alone.
void Solid_Bounds::Add(const ObjectBase& object, bool part)
{
	const size_t here = parts.size();
	parts.push_back(Part());
	const CSG *csg = dynamic_cast<const CSG *>(&object);
	const Plane *plane = dynamic_cast<const Plane *>(&object);
	const bool inverted = Test_Flag(&object, INVERTED_FLAG);
	parts[here].kind = Part::ANYTHING;
	if((csg != NULL) && inverted)
		; // all of space but it
	else if(csg != NULL)
	{
		const bool all = (dynamic_cast<const CSGIntersection *>(csg) != NULL);
		parts[here].kind = all ? Part::ALL_OF : Part::ANY_OF;
		for(size_t i = 0; i < csg->children.size(); i++)
			Add(*csg->children[i], part || all);
	}
	else if((plane != NULL) && (plane->Trans == NULL) && part)
	{
		parts[here].kind = Part::HALF_SPACE;
		Assign_Vector(parts[here].normal, plane->Normal_Vector);
		parts[here].distance = plane->Distance;
	}
	else if((plane == NULL) && !(part && inverted) && (dynamic_cast<const HField *>(&object) == NULL))
	{
		parts[here].kind = Part::BOX;
		parts[here].box.Take(object, margin);
	}
	parts[here].after = parts.size();
}

bool Solid_Bounds::Holds(size_t n, const Scene_Chord& c) const
{
	const Part& p = parts[n];
	switch(p.kind)
	{
		case Part::ALL_OF:
			for(size_t i = n + 1; i < p.after; i = parts[i].after)
				if(!Holds(i, c))
					return false;
			return true;
		case Part::ANY_OF:
			for(size_t i = n + 1; i < p.after; i = parts[i].after)
				if(Holds(i, c))
					return true;
			return false;
		case Part::HALF_SPACE:
		{
			DBL a, b;
			VDot(a, p.normal, c.from);
			VDot(b, p.normal, c.to);
			return min(a, b) + p.distance <= margin + c.bulge;
		}
		case Part::BOX:
			return p.box.Meets(c);
		default:
			return true;
	}
}

}
