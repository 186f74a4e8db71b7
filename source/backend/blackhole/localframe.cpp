// SPDX-License-Identifier: AGPL-3.0-or-later
// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/blackhole/bentrays.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/bentsegment.h"
#include "backend/blackhole/localframe.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using blackhole::Vec3;

// The chord that hit and the path's tangent there differ by half the chord's turn: where they disagree on which
// side of the surface they come from, the chord is right (it is what hit) and the tangent grazes.
static Vec3 Graze(const Vec3& tangent, const Vec3& chord, const Vec3& normal)
{
	const DBL n2 = dot(normal, normal), t = dot(tangent, normal), c = dot(chord, normal);
	if((t * c > 0.0) || (n2 == 0.0))
		return tangent;
	return unit(tangent - (t / n2) * normal + (c < 0.0 ? -1e-6 : 1e-6) / sqrt(n2) * normal);
}

Local_Frame::Local_Frame(const Bent_Rays *bent, const Ray& r, const Vector3d& n, const VECTOR point) :
	ray(r), normal(n), hole(NULL), bentray(NULL)
{
	const Bent_Segment *way = bent != NULL ? bent->Shaded(r) : NULL;
	if((way == NULL) || !way->has_tangent)
		return;
	hole = bent->holes.At(point);
	if(hole == NULL)
		return;
	x = hole->To_Hole(point);
	const Vec3 scene_normal = Vec3_Of(*n);
	const DBL R = hole->Settings().effect_radius;
	bentray = new Ray(r);
	Assign_Vec3(bentray->Direction, coordinate_to_static(x, Graze(way->tangent, Vec3_Of(r.Direction), scene_normal), R));
	bentnormal = n;
	Turn(bentnormal);
}

void Local_Frame::Turn(Vector3d& n) const
{
	if(bentray == NULL)
		return;
	const Vec3 t = normal_to_static(x, Vec3_Of(*n), hole->Settings().effect_radius);
	n = Vector3d(t.x, t.y, t.z);
}

}
