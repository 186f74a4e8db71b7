// SPDX-License-Identifier: AGPL-3.0-or-later
/// The `blackhole` primitive: a thing of the scene that is declared, copied and moved as objects are,
/// and that no ray ever hits. What it does to rays is in blackholes.h and bentrays.h.
#ifndef POVRAY_BLACKHOLE_H
#define POVRAY_BLACKHOLE_H

#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "blackhole/frames.h"
#include "blackhole/path.h"

namespace pov
{

class Blackhole : public ObjectBase
{
	public:
		enum Camera_Frame { STATIC_CAMERA, FALLING_CAMERA, COORDINATE_CAMERA };

		VECTOR Center;
		DBL Radius;        ///< Schwarzschild radius, scene units
		DBL Effect_Radius; ///< scene units; 0: the default, ten thousand Radius
		DBL Tolerance;     ///< radians
		blackhole::Method Method;
		Camera_Frame Camera;
		bool Distorted;    ///< was transformed by something other than moves, rotations and uniform scales

		/// Where the scene says it, for messages about it after parsing.
		UCS2String File;
		POV_LONG Line;

		Blackhole();

		virtual ObjectPtr Copy();
		virtual bool All_Intersections(const Ray&, IStack&, TraceThreadData *) { return false; }
		virtual bool Inside(const VECTOR, TraceThreadData *) const { return false; }
		virtual void Normal(VECTOR, Intersection *, TraceThreadData *) const { }
		virtual void Translate(const VECTOR, const TRANSFORM *);
		virtual void Rotate(const VECTOR, const TRANSFORM *);
		virtual void Scale(const VECTOR, const TRANSFORM *);
		virtual void Transform(const TRANSFORM *);
		virtual void Invert() { }
		virtual void Compute_BBox();

		DBL Reach() const { return Effect_Radius > 0.0 ? Effect_Radius : 10000.0 * Radius; }
		/// The effect radius in Schwarzschild radii.
		DBL Rim() const { return Reach() / Radius; }
		blackhole::Settings Settings() const;
		/// Scene coordinates to the hole's: relative to the centre, in Schwarzschild radii; and back.
		blackhole::Vec3 To_Hole(const VECTOR p) const
		{
			const blackhole::Vec3 x = { (p[X] - Center[X]) / Radius, (p[Y] - Center[Y]) / Radius, (p[Z] - Center[Z]) / Radius };
			return x;
		}
		void To_Scene(const blackhole::Vec3& x, VECTOR p) const
		{
			Make_Vector(p, Center[X] + Radius * x.x, Center[Y] + Radius * x.y, Center[Z] + Radius * x.z);
		}
		/// Distance of a point from the centre, scene units.
		DBL Distance(const VECTOR p) const;
		/// Whether a point is inside the effect sphere.
		bool Reaches(const VECTOR p) const
		{
			const DBL x = p[X] - Center[X], y = p[Y] - Center[Y], z = p[Z] - Center[Z], reach = Reach();
			return x * x + y * y + z * z < reach * reach;
		}
		/// Whether the straight segment from p in direction d (unit) over the length meets the horizon.
		bool Blocks(const VECTOR p, const VECTOR d, DBL length) const;
};

inline blackhole::Vec3 Vec3_Of(const VECTOR v) { blackhole::Vec3 r = { v[X], v[Y], v[Z] }; return r; }
inline void Assign_Vec3(VECTOR v, const blackhole::Vec3& x) { v[X] = x.x; v[Y] = x.y; v[Z] = x.z; }

}

#endif
