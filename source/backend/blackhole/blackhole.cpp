// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/math/matrices.h"
#include "backend/bounding/bbox.h"
#include "backend/blackhole/blackhole.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

Blackhole::Blackhole() :
	ObjectBase(BASIC_OBJECT),
	Radius(1.0),
	Effect_Radius(0.0),
	Tolerance(1e-4), // an eighth of a pixel of 1920 across; coarser saves no time worth it: docs/accuracy.md
	Method(blackhole::Method::rk4),
	Camera(STATIC_CAMERA),
	Distorted(false),
	Line(0)
{
	Make_Vector(Center, 0.0, 0.0, 0.0);
}

ObjectPtr Blackhole::Copy()
{
	Blackhole *New = new Blackhole();
	Assign_Vector(New->Center, Center);
	New->Radius = Radius;
	New->Effect_Radius = Effect_Radius;
	New->Tolerance = Tolerance;
	New->Method = Method;
	New->Camera = Camera;
	New->Distorted = Distorted;
	New->File = File;
	New->Line = Line;
	New->Compute_BBox();
	return New;
}

void Blackhole::Translate(const VECTOR, const TRANSFORM *tr)
{
	Transform(tr);
}

void Blackhole::Rotate(const VECTOR, const TRANSFORM *tr)
{
	Transform(tr);
}

void Blackhole::Scale(const VECTOR, const TRANSFORM *tr)
{
	Transform(tr);
}

void Blackhole::Transform(const TRANSFORM *tr)
{
	// A similarity sends the axes to perpendicular vectors of one length.
	const DBL (*m)[4] = tr->matrix;
	DBL product[3][3];
	for(int i = 0; i < 3; i++)
		for(int j = 0; j < 3; j++)
			product[i][j] = m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
	const DBL square = (product[0][0] + product[1][1] + product[2][2]) / 3.0;
	for(int i = 0; i < 3; i++)
		for(int j = 0; j < 3; j++)
			if(!(fabs(product[i][j] - (i == j ? square : 0.0)) <= 1e-6 * square))
				Distorted = true;

	MTransPoint(Center, Center, tr);
	Radius *= sqrt(square);
	Effect_Radius *= sqrt(square);
	Compute_BBox();
}

void Blackhole::Compute_BBox()
{
	// Where rays bend is no bound for anything; a union's own bound must not become infinite through a hole in it.
	Make_BBox(BBox, Center[X] - Radius, Center[Y] - Radius, Center[Z] - Radius, 2.0 * Radius, 2.0 * Radius, 2.0 * Radius);
}

blackhole::Settings Blackhole::Settings() const
{
	blackhole::Settings s;
	s.effect_radius = Rim();
	s.tolerance = Tolerance;
	s.method = Method;
	return s;
}

DBL Blackhole::Distance(const VECTOR p) const
{
	DBL d;
	VDist(d, p, Center);
	return d;
}

bool Blackhole::Blocks(const VECTOR p, const VECTOR d, DBL length) const
{
	const blackhole::Vec3 x = To_Hole(p), u = Vec3_Of(d);
	const DBL along = std::max(0.0, std::min(-dot(x, u), length / Radius));
	const blackhole::Vec3 nearest = x + along * u;
	return dot(nearest, nearest) <= 1.0;
}

}
