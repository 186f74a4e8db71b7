// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/shape/planes.h"
#include "backend/shape/spheres.h"
#include "backend/blackhole/blackhole.h"
#include "backend/blackhole/chordtree.h"
#include "backend/blackhole/planecut.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::all;
using blackhole::Four;
using blackhole::greater;
using blackhole::lesser;
using blackhole::not_greater;
using blackhole::root;
using blackhole::Vec3;

// What single precision may lose of a number of this size, several times over.
static DBL Rounding(DBL size)
{
	return 1e-6 * size;
}

Few_Objects::Few_Objects(const Chord_Tree& tree, const std::vector<std::pair<DBL, DBL> >& radii, const Blackhole& hole) :
	smooth(0), margin(tree.Margin() / hole.Radius), few(false)
{
	std::vector<Ball> round, boxed;
	for(unsigned int i = 0; i < tree.Count(); i++)
	{
		if(radii[i].first > hole.Rim())
			continue;
		const pov::Plane *plane = dynamic_cast<const pov::Plane *>(tree.Object(i));
		const Sphere *sphere = dynamic_cast<const Sphere *>(tree.Object(i));
		Ball ball = { { i, radii[i] }, Vec3(), 0.0 };
		if((plane != NULL) && (plane->Trans == NULL))
		{
			const Vec3 normal = Vec3_Of(plane->Normal_Vector);
			const Plane flat = { i, normal, (dot(normal, Vec3_Of(hole.Center)) + plane->Distance) / hole.Radius };
			planes.push_back(flat);
		}
		else if((sphere != NULL) && (sphere->Trans == NULL))
		{
			ball.center = hole.To_Hole(sphere->Center);
			ball.radius = (fabs(sphere->Radius) + 1e-12 * length(Vec3_Of(hole.Center))) / hole.Radius + margin;
			round.push_back(ball);
		}
		else if(tree.Ball(i, hole, ball.center, ball.radius))
			boxed.push_back(ball);
		else
			anywhere.push_back(ball.object);
		if((round.size() + boxed.size() > MOST) || (planes.size() > MOST_PLANES) || (anywhere.size() > MOST_ANYWHERE))
			return;
	}
	smooth = Add(round);
	Add(boxed);
	few = true;
}

// To the spheres, up to a multiple of four, by nothing where there is no fourth; how many there are then.
size_t Few_Objects::Add(const std::vector<Ball>& some)
{
	for(size_t i = 0; i < some.size(); i++)
	{
		const size_t k = i % 4;
		if(k == 0)
		{
			const Spheres none = { all(0.0), all(0.0), all(0.0), all(-1.0) };
			fours.push_back(none);
			balls.resize(balls.size() + 4);
		}
		const Ball& ball = some[i];
		fours.back().x[k] = float(ball.center.x);
		fours.back().y[k] = float(ball.center.y);
		fours.back().z[k] = float(ball.center.z);
		fours.back().square[k] = float(Sqr(ball.radius + Rounding(length(ball.center) + ball.radius)));
		balls[balls.size() - 4 + k] = ball.object;
	}
	return balls.size();
}

bool Plane_Cut::Begin(const Few_Objects& o, const Vec3& e1, const Vec3& e2)
{
	const Vec3 axis = cross(e1, e2);
	const Four nx = all(axis.x), ny = all(axis.y), nz = all(axis.z), none = all(0.0);
	const Four ax = all(e1.x), ay = all(e1.y), az = all(e1.z), bx = all(e2.x), by = all(e2.y), bz = all(e2.z);
	size_t n = 0, smooth = MOST;
	for(size_t i = 0, end = o.fours.size(), turn = o.smooth / 4; i < end; i++)
	{
		if(i == turn)
			smooth = n;
		const Few_Objects::Spheres& s = o.fours[i];
		const Four h = nx * s.x + ny * s.y + nz * s.z, left = s.square - h * h;
		int meets = not_greater(none, left);
		if(meets == 0)
			continue;
		// What is too large for single precision is no number here, and may be anywhere.
		const Four x = ax * s.x + ay * s.y + az * s.z, y = bx * s.x + by * s.y + bz * s.z, r = root(greater(none, left));
		for(; meets != 0; meets &= meets - 1)
		{
			if(n == MOST)
				return false;
			const int k = __builtin_ctz(meets);
			const float dx = x[k], dy = y[k], dr = r[k];
			const Disc d = { { dx, dx, dx, dx }, { dy, dy, dy, dy }, { dr, dr, dr, dr }, 4 * i + k };
			disc[n++] = d;
		}
	}
	objects = &o;
	discs = n;
	rough = ((Set(1) << discs) - (Set(1) << min(smooth, discs))) | ((Set(1) << o.anywhere.size()) - 1) << ANYWHERE_AT;
	lines = o.planes.size();
	for(size_t i = 0; i < lines; i++)
	{
		const Few_Objects::Plane& plane = o.planes[i];
		line[i].x = all(dot(plane.normal, e1));
		line[i].y = all(dot(plane.normal, e2));
		line[i].distance = all(plane.distance);
		line[i].close = float(o.margin + Rounding(fabs(plane.distance)));
	}
	return true;
}

static inline bool In_Shell(const blackhole::Pieces& pieces, int i, const std::pair<DBL, DBL>& shell)
{
	return !(pieces.nearest[i] > shell.second) && !(shell.first > pieces.farthest[i]);
}

void Plane_Cut::Near(const blackhole::Pieces& p, Set *near) const
{
	const Four none = all(0.0), one = all(1.0), per = 1.0f / (p.dx * p.dx + p.dy * p.dy), tx = p.dx * per, ty = p.dy * per;
	near[0] = near[1] = near[2] = near[3] = 0;
	for(size_t n = 0; n < discs; n++)
	{
		const Disc& d = disc[n];
		const Four px = d.x - p.x, py = d.y - p.y, t = greater(lesser(px * tx + py * ty, one), none);
		const Four qx = px - t * p.dx, qy = py - t * p.dy, reach = d.radius + p.bulge;
		for(int meets = not_greater(qx * qx + qy * qy, reach * reach); meets != 0; meets &= meets - 1)
		{
			const int i = __builtin_ctz(meets);
			if(In_Shell(p, i, objects->balls[d.ball].shell))
				near[i] |= Set(1) << n;
		}
	}
	for(size_t n = 0; n < lines; n++)
	{
		const Line& l = line[n];
		const Four a = l.x * p.x + l.y * p.y + l.distance, b = a + l.x * p.dx + l.y * p.dy, close = l.close + p.bulge;
		for(int meets = not_greater(lesser(a, b), close) & not_greater(-close, greater(a, b)); meets != 0; meets &= meets - 1)
			near[__builtin_ctz(meets)] |= Set(1) << (PLANES_AT + n);
	}
	for(size_t n = 0; n < objects->anywhere.size(); n++)
		for(int i = 0; i < 4; i++)
			if(In_Shell(p, i, objects->anywhere[n].shell))
				near[i] |= Set(1) << (ANYWHERE_AT + n);
}

unsigned int Plane_Cut::First(Set set) const
{
	const size_t i = __builtin_ctzll(set);
	if(i >= ANYWHERE_AT)
		return objects->anywhere[i - ANYWHERE_AT].number;
	return i >= PLANES_AT ? objects->planes[i - PLANES_AT].number : objects->balls[disc[i].ball].number;
}

}
