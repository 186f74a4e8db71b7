// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/blackhole/bentpath.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/blackholes.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::Pieces;
using blackhole::Route;
using blackhole::Vec3;

bool Bent_Path::Every_Chord() const
{
	return volume || (bent->recorder != NULL) || (state->budget < BOUND_HUGE);
}


// What piece i may hit, boxes and solids' parts compared too.
static Plane_Cut::Set Closer(const Plane_Cut& cut, Plane_Cut::Set near, const Pieces& p, int i, const Route& route, const Chord_Tree& tree, const Chord_Tree::Radii_List& radii, const Blackhole& hole)
{
	Scene_Chord chord;
	hole.To_Scene(DBL(p.x[i]) * route.e1() + DBL(p.y[i]) * route.e2(), chord.from);
	hole.To_Scene(DBL(p.x[i] + p.dx[i]) * route.e1() + DBL(p.y[i] + p.dy[i]) * route.e2(), chord.to);
	chord.bulge = p.bulge[i] * hole.Radius;
	chord.nearest = p.nearest[i];
	chord.farthest = p.farthest[i];
	for(Plane_Cut::Set rough = near & cut.Rough(); rough != 0; rough &= rough - 1)
		if(!tree.May_Hit(chord, radii, cut.First(rough)))
			near &= ~(rough & -rough);
	return near;
}

bool Bent_Path::Along_Pieces(size_t index, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	// Four to the power of something, and as many as turn by a third of a radian or so.
	int chords = 1;
	while(Sqr(4.0 * chords) * bent->holes.Holes()[index]->Tolerance < 0.09)
		chords *= 4;
	return Along_Pieces(index, 0, bent->route.chords(), chords, isect, pre, post);
}

bool Bent_Path::Along_Pieces(size_t index, int first, int last, int chords, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post)
{
	const Blackhole& hole = *bent->holes.Holes()[index];
	Route& route = bent->route;
	Pieces p;
	Plane_Cut::Set near[4];
	while(first < last)
	{
		const int count = route.pieces(first, last, chords, p);
		bent->cut.Near(p, near);
		for(int i = 0; i < count; i++, first += chords)
		{
			const int end = min(first + chords, last);
			Plane_Cut::Set left = near[i];
			if((left & bent->cut.Rough()) != 0)
				left = Closer(bent->cut, left, p, i, route, bent->holes.Tree(), bent->holes.Radii_Of(index), hole);
			if(left == 0)
			{
				Skip(end - first, p.length[i] * hole.Radius);
				continue;
			}
			if(chords > 1)
			{
				if(Along_Pieces(index, first, end, chords / 4, isect, pre, post))
					return true;
				continue;
			}
			bent->chosen.clear();
			for(; left != 0; left &= left - 1)
				bent->chosen.push_back(bent->cut.First(left));
			if(bent->chosen.size() > 1)
				std::sort(bent->chosen.begin(), bent->chosen.end());
			blackhole::Chord c;
			Scene_Chord chord;
			bool found;
			route.go_to(first);
			route.next(c);
			In_Scene(c, 0.0, hole, chord);
			if(Along_Chord(route, c, chord, bent->chosen, index, isect, pre, post, found))
				return found;
		}
	}
	return false;
}

}
