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

struct Local_Frame::Seen
{
	Seen(const Ray& r) : ray(r) { }
	const Blackhole *hole;
	Vec3 x;
	Ray ray;
	Vector3d normal;
};

void Local_Frame::Begin(const Bent_Rays *bent)
{
	const Bent_Segment *way = bent->Shaded(*ray);
	if(way == NULL)
		return;
	chord_depth = isect.Depth;
	isect.Depth += way->travelled;
	if(!way->has_tangent)
		return;
	const Blackhole *hole = bent->holes.At(isect.IPoint);
	if(hole == NULL)
		return;
	seen = new Seen(*ray);
	seen->hole = hole;
	seen->x = hole->To_Hole(isect.IPoint);
	const Vec3 scene_normal = Vec3_Of(**normal);
	const DBL R = hole->Rim();
	Assign_Vec3(seen->ray.Direction, coordinate_to_static(seen->x, Graze(way->tangent, Vec3_Of(ray->Direction), scene_normal), R));
	seen->normal = *normal;
	Bent_Turn(seen->normal);
	ray = &seen->ray;
	normal = &seen->normal;
}

void Local_Frame::End()
{
	isect.Depth = chord_depth;
	delete seen;
}

void Local_Frame::Bent_Turn(Vector3d& n) const
{
	const Vec3 t = normal_to_static(seen->x, Vec3_Of(*n), seen->hole->Rim());
	n = Vector3d(t.x, t.y, t.z);
}

}
