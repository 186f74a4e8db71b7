// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/shape/planes.h"
#include "backend/blackhole/chordtree.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

static void Widen(Chord_Run::Box& b)
{
	b.widest = max(b.hi[0] - b.lo[0], max(b.hi[1] - b.lo[1], b.hi[2] - b.lo[2]));
}

static void Join(Chord_Run::Box& box, const Chord_Run::Box& a, const Chord_Run::Box& b)
{
	for(int i = 0; i < 3; i++)
	{
		box.lo[i] = a.lo[i] < b.lo[i] ? a.lo[i] : b.lo[i];
		box.hi[i] = a.hi[i] > b.hi[i] ? a.hi[i] : b.hi[i];
	}
	Widen(box);
}

static bool Overlap(const Chord_Run::Box& a, const Chord_Run::Box& b)
{
	return (a.lo[0] <= b.hi[0]) && (b.lo[0] <= a.hi[0]) && (a.lo[1] <= b.hi[1]) && (b.lo[1] <= a.hi[1]) && (a.lo[2] <= b.hi[2]) && (b.lo[2] <= a.hi[2]);
}

// Whether the segment meets the box.
static bool Meets(const Chord_Run::Chord& c, const Chord_Run::Box& box)
{
	DBL in = 0.0, out = 1.0;
	for(int i = 0; i < 3; i++)
	{
		const DBL d = c.to[i] - c.from[i];
		if(fabs(d) < 1e-30)
		{
			if((c.from[i] < box.lo[i]) || (c.from[i] > box.hi[i]))
				return false;
			continue;
		}
		const DBL a = (box.lo[i] - c.from[i]) / d, b = (box.hi[i] - c.from[i]) / d;
		in = max(in, min(a, b));
		out = min(out, max(a, b));
		if(in > out)
			return false;
	}
	return true;
}

void Chord_Run::Bound()
{
	for(int j = 0; j < MOST; j++)
	{
		Box& b = boxes[MOST + j];
		for(int i = 0; i < 3; i++)
		{
			b.lo[i] = j < count ? min(chords[j].from[i], chords[j].to[i]) : HUGE_VAL;
			b.hi[i] = j < count ? max(chords[j].from[i], chords[j].to[i]) : -HUGE_VAL;
			if(arcs && (j < count))
			{
				b.lo[i] -= chords[j].bulge;
				b.hi[i] += chords[j].bulge;
			}
		}
		Widen(b);
	}
	for(int i = MOST - 1; i > 0; i--)
		Join(boxes[i], boxes[2 * i], boxes[2 * i + 1]);
}

void Chord_Tree::Build(const std::vector<ObjectPtr>& scene, DBL m)
{
	margin = m;
	std::vector<int> list;
	for(size_t k = 0; k < scene.size(); k++)
	{
		if(!Visible(*scene[k]))
			continue;
		Chord_Run::Box box;
		for(int i = 0; i < 3; i++)
		{
			const DBL lo = scene[k]->BBox.Lower_Left[i], hi = lo + scene[k]->BBox.Lengths[i], more = margin + 1e-6 * max(fabs(lo), fabs(hi)); // boxes are in single precision
			box.lo[i] = lo - more;
			box.hi[i] = hi + more;
		}
		// A plane's box is half of space; so is that of most things as large as this.
		Widen(box);
		if(box.widest > 1e6)
			endless.push_back((unsigned int)objects.size());
		else
			list.push_back(int(objects.size()));
		const Plane *plane = dynamic_cast<const Plane *>(scene[k]);
		planes.push_back((plane != NULL) && (plane->Trans == NULL) ? plane : NULL);
		objects.push_back(scene[k]);
		boxes.push_back(box);
	}
	if(list.empty())
		return;
	nodes.push_back(Node());
	Split(0, list, 0, list.size());
}

void Chord_Tree::Split(int n, std::vector<int>& list, size_t from, size_t to)
{
	Chord_Run::Box box = boxes[list[from]];
	for(size_t i = from + 1; i < to; i++)
		Join(box, box, boxes[list[i]]);
	nodes[n].box = box;
	nodes[n].left = -1;
	nodes[n].object = list[from];
	if(to - from == 1)
		return;
	int axis = 0;
	for(int i = 1; i < 3; i++)
		if(box.hi[i] - box.lo[i] > box.hi[axis] - box.lo[axis])
			axis = i;
	std::vector<std::pair<DBL, int> > order;
	for(size_t i = from; i < to; i++)
		order.push_back(std::make_pair(boxes[list[i]].lo[axis] + boxes[list[i]].hi[axis], list[i]));
	std::sort(order.begin(), order.end());
	for(size_t i = from; i < to; i++)
		list[i] = order[i - from].second;
	const size_t middle = from + (to - from) / 2;
	const int left = int(nodes.size());
	nodes.push_back(Node());
	nodes.push_back(Node());
	nodes[n].left = left;
	Split(left, list, from, middle);
	Split(left + 1, list, middle, to);
}

std::vector<std::pair<DBL, DBL> > Chord_Tree::Radii_Around(const Blackhole& hole) const
{
	std::vector<std::pair<DBL, DBL> > radii(objects.size());
	for(size_t i = 0; i < objects.size(); i++)
	{
		Radii(*objects[i], hole, radii[i].first, radii[i].second);
		radii[i].first -= margin / hole.Radius;
		radii[i].second += margin / hole.Radius;
	}
	return radii;
}

static DBL Height(const VECTOR p, const Plane *plane)
{
	DBL h;
	VDot(h, plane->Normal_Vector, p);
	return h + plane->Distance;
}

// Whether a chord, or an arc, may meet a plane: not if all of it is well on one side.
static bool May_Meet(const Chord_Run::Chord& c, bool arc, const Plane *plane, DBL margin)
{
	const DBL a = Height(c.from, plane), b = Height(c.to, plane), near = margin + (arc ? c.bulge : 0.0);
	return (min(a, b) <= near) && (max(a, b) >= -near);
}

void Chord_Tree::Choose(const Chord_Run::Chord& chord, const std::vector<std::pair<DBL, DBL> >& radii, const std::vector<unsigned int>& of, std::vector<unsigned int>& out) const
{
	out.clear();
	for(size_t i = 0; i < of.size(); i++)
	{
		const std::pair<DBL, DBL>& r = radii[of[i]];
		if((chord.nearest <= r.second) && (r.first <= chord.farthest) && (planes[of[i]] != NULL ? May_Meet(chord, false, planes[of[i]], margin) : Meets(chord, boxes[of[i]])))
			out.push_back(of[i]);
	}
}

void Chord_Tree::Find(Chord_Run& run, const std::vector<std::pair<DBL, DBL> >& radii, Chord_Candidates& out) const
{
	out.found.clear();
	out.taken = 0;
	if(run.Count() == 0)
		return;
	run.Bound();
	for(size_t k = 0; k < endless.size(); k++)
	{
		const unsigned int object = endless[k];
		const std::pair<DBL, DBL>& r = radii[object];
		for(int j = 0; j < run.Count(); j++)
			if((run[j].nearest <= r.second) && (r.first <= run[j].farthest) && ((planes[object] == NULL) || May_Meet(run[j], run.Arcs(), planes[object], margin)))
				out.found.push_back(std::make_pair(j, object));
	}
	out.stack.clear();
	// Pairs of boxes that overlap; the wider of each is split.
	if(!nodes.empty() && Overlap(nodes[0].box, run.Heap(1)))
		out.stack.push_back(std::make_pair(0, 1));
	while(!out.stack.empty())
	{
		const int n = out.stack.back().first, h = out.stack.back().second;
		out.stack.pop_back();
		const Node& node = nodes[n];
		const bool one_chord = (h >= Chord_Run::MOST), leaf = (node.left < 0);
		if(one_chord && leaf)
		{
			const Chord_Run::Chord& c = run[h - Chord_Run::MOST];
			const std::pair<DBL, DBL>& r = radii[node.object];
			if((c.nearest <= r.second) && (r.first <= c.farthest) && (run.Arcs() || Meets(c, node.box)))
				out.found.push_back(std::make_pair(h - Chord_Run::MOST, (unsigned int)node.object));
		}
		else if(leaf || (!one_chord && (run.Heap(h).widest > node.box.widest)))
		{
			for(int i = 2 * h; i <= 2 * h + 1; i++)
				if(Overlap(node.box, run.Heap(i)))
					out.stack.push_back(std::make_pair(n, i));
		}
		else
		{
			for(int i = node.left; i <= node.left + 1; i++)
				if(Overlap(nodes[i].box, run.Heap(h)))
					out.stack.push_back(std::make_pair(i, h));
		}
	}
	if(out.found.size() > 1)
		std::sort(out.found.begin(), out.found.end());
}

}
