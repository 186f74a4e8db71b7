// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/shape/csg.h"
#include "backend/shape/planes.h"
#include "backend/blackhole/chordtree.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::greater;
using blackhole::lesser;
using blackhole::not_greater;
using blackhole::Vec3;

// What single precision may lose of a number of this size, several times over.
static DBL Rounding(DBL size)
{
	return 1e-6 * size;
}

void Chord_Tree::Build(const std::vector<ObjectPtr>& scene, DBL m)
{
	margin = m;
	std::vector<int> list;
	for(size_t k = 0; k < scene.size(); k++)
	{
		if(!Visible(*scene[k]))
			continue;
		Scene_Box box;
		box.Take(*scene[k], margin);
		const DBL widest = max(box.hi[0] - box.lo[0], max(box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]));
		// A plane's box is half of space; so is that of most things as large as this.
		if(!(widest <= 1e6))
			endless.push_back((unsigned int)objects.size());
		else
			list.push_back(int(objects.size()));
		const Plane *plane = dynamic_cast<const Plane *>(scene[k]);
		planes.push_back((plane != NULL) && (plane->Trans == NULL) ? plane : NULL);
		const bool made_of_others = (dynamic_cast<const CSG *>(scene[k]) != NULL);
		solids.push_back(made_of_others ? int(bounds.size()) : -1);
		if(made_of_others)
			bounds.push_back(Solid_Bounds(*scene[k], margin));
		objects.push_back(scene[k]);
		boxes.push_back(box);
	}
	if(!list.empty())
		Split(list, 0, list.size());
}

// Makes a node of the objects list[from] to list[to - 1], in four parts along the longest sides of their centres.
int Chord_Tree::Split(std::vector<int>& list, size_t from, size_t to)
{
	const int n = int(nodes.size());
	nodes.push_back(Node());
	size_t cuts[5] = { from, from, (from + to) / 2, to, to };
	const auto halve = [&](size_t first, size_t last)
	{
		const size_t middle = (first + last) / 2;
		int axis = 0;
		DBL longest = -1.0;
		const auto centre = [&](int object, int i) { return boxes[object].lo[i] + boxes[object].hi[i]; };
		for(int i = 0; i < 3; i++)
		{
			DBL lo = HUGE_VAL, hi = -HUGE_VAL;
			for(size_t k = first; k < last; k++)
			{
				lo = min(lo, centre(list[k], i));
				hi = max(hi, centre(list[k], i));
			}
			if(hi - lo > longest)
			{
				longest = hi - lo;
				axis = i;
			}
		}
		std::sort(list.begin() + first, list.begin() + last, [&](int a, int b) { return std::make_pair(centre(a, axis), a) < std::make_pair(centre(b, axis), b); });
		return middle;
	};
	if(to - from > 1)
	{
		cuts[2] = halve(from, to);
		cuts[1] = cuts[2] - from > 1 ? halve(from, cuts[2]) : from;
		cuts[3] = to - cuts[2] > 1 ? halve(cuts[2], to) : to;
	}
	for(int c = 0; c < 4; c++)
	{
		Scene_Box all = { { 1e30, 1e30, 1e30 }, { -1e30, -1e30, -1e30 } };
		for(size_t k = cuts[c]; k < cuts[c + 1]; k++)
			for(int i = 0; i < 3; i++)
			{
				all.lo[i] = min(all.lo[i], boxes[list[k]].lo[i]);
				all.hi[i] = max(all.hi[i], boxes[list[k]].hi[i]);
			}
		for(int i = 0; i < 3; i++)
		{
			const DBL more = Rounding(max(fabs(all.lo[i]), fabs(all.hi[i])));
			nodes[n].side[0][i][c] = float(all.lo[i] - more);
			nodes[n].side[1][i][c] = float(all.hi[i] + more);
		}
		const size_t in = cuts[c + 1] - cuts[c];
		const int child = in > 1 ? Split(list, cuts[c], cuts[c + 1]) : (in == 1 ? ~list[cuts[c]] : 0);
		nodes[n].child[c] = child;
	}
	return n;
}

Chord_Tree::Radii_List Chord_Tree::Radii_Around(const Blackhole& hole) const
{
	Radii_List radii(objects.size());
	for(size_t i = 0; i < objects.size(); i++)
	{
		Radii(*objects[i], hole, radii[i].first, radii[i].second);
		radii[i].first -= margin / hole.Radius;
		radii[i].second += margin / hole.Radius;
	}
	return radii;
}

bool Chord_Tree::Ball(unsigned int object, const Blackhole& hole, Vec3& center, DBL& radius) const
{
	if(std::find(endless.begin(), endless.end(), object) != endless.end())
		return false;
	const Scene_Box& box = boxes[object];
	VECTOR middle;
	DBL square = 0.0;
	for(int i = 0; i < 3; i++)
	{
		middle[i] = 0.5 * (box.lo[i] + box.hi[i]);
		square += Sqr(0.5 * (box.hi[i] - box.lo[i]));
	}
	center = hole.To_Hole(middle);
	radius = sqrt(square) / hole.Radius;
	return true;
}

static DBL Height(const VECTOR p, const Plane *plane)
{
	DBL h;
	VDot(h, plane->Normal_Vector, p);
	return h + plane->Distance;
}

static inline bool In_Shell(const Scene_Chord& c, const std::pair<DBL, DBL>& shell)
{
	return (c.nearest <= shell.second) && (shell.first <= c.farthest);
}

// Whether a chord, or an arc, may meet an object: a plane not if all of it is well on one side.
bool Chord_Tree::May_Hit(const Scene_Chord& c, const Radii_List& radii, unsigned int object) const
{
	if(!In_Shell(c, radii[object]))
		return false;
	if(const Plane *plane = planes[object])
	{
		const DBL a = Height(c.from, plane), b = Height(c.to, plane), near = margin + c.bulge;
		return (min(a, b) <= near) && (max(a, b) >= -near);
	}
	return boxes[object].Meets(c) && ((solids[object] < 0) || bounds[solids[object]].May_Hit(c));
}

void Chord_Tree::Choose(const Scene_Chord& chord, const Radii_List& radii, const Object_List& of, Object_List& out) const
{
	out.clear();
	for(size_t i = 0; i < of.size(); i++)
		if(May_Hit(chord, radii, of[i]))
			out.push_back(of[i]);
}

void Chord_Tree::Find(const Scene_Chord& c, const Radii_List& radii, Object_List& out) const
{
	out.clear();
	for(size_t k = 0; k < endless.size(); k++)
		if(May_Hit(c, radii, endless[k]))
			out.push_back(endless[k]);
	if(nodes.empty())
		return;
	// The slabs of four boxes at a time, widened by the bulge: near and far side by the chord's own direction.
	Four near_side[3], far_side[3], per[3];
	int sign[3];
	DBL size = c.bulge;
	for(int i = 0; i < 3; i++)
		size = max(size, max(fabs(c.from[i]), fabs(c.to[i])));
	const DBL wide = c.bulge + Rounding(size);
	for(int i = 0; i < 3; i++)
	{
		const DBL d = c.to[i] - c.from[i], w = d < 0.0 ? -wide : wide;
		const float n = float(c.from[i] + w), f = float(c.from[i] - w), p = 1.0f / (fabs(d) < 1e-20 ? 1e-20f : float(d));
		near_side[i] = Four{ n, n, n, n };
		far_side[i] = Four{ f, f, f, f };
		per[i] = Four{ p, p, p, p };
		sign[i] = d < 0.0;
	}
	int stack[256], depth = 0;
	stack[depth++] = 0;
	while(depth > 0)
	{
		const Node& node = nodes[stack[--depth]];
		Four in = { 0, 0, 0, 0 }, beyond = { 1, 1, 1, 1 };
		for(int i = 0; i < 3; i++)
		{
			in = greater((node.side[sign[i]][i] - near_side[i]) * per[i], in);
			beyond = lesser((node.side[1 - sign[i]][i] - far_side[i]) * per[i], beyond);
		}
		for(int meets = not_greater(in, beyond); meets != 0; meets &= meets - 1)
		{
			const int child = node.child[__builtin_ctz(meets)];
			if(child > 0)
				stack[depth++] = child;
			else if((child < 0) && In_Shell(c, radii[~child]))
				out.push_back((unsigned int)(~child));
		}
	}
	if(out.size() > 1)
		std::sort(out.begin(), out.end());
}

}
