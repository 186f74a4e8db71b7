// SPDX-License-Identifier: AGPL-3.0-or-later
/// The static observer's frame at a surface, in which shading, reflection and refraction are done.
#ifndef POVRAY_BLACKHOLE_LOCALFRAME_H
#define POVRAY_BLACKHOLE_LOCALFRAME_H

#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/render/ray.h"
#include "blackhole/vec.h"

namespace pov
{

class Bent_Rays;
class Blackhole;

/// What a surface sees of a bent ray that hit it: direction and normal in the static frame there, and the depth of
/// the hit along the whole way instead of the last chord (for fading), until the frame ends.
class Local_Frame
{
	public:
		// The tests for NULL are inline, as in Bent_Path.
		Local_Frame(const Bent_Rays *bent, const Ray& r, const Vector3d& n, Intersection& hit) : ray(&r), normal(&n), isect(hit), chord_depth(-1.0), seen(NULL) { if(bent != NULL) Begin(bent); }
		~Local_Frame() { if(chord_depth >= 0.0) End(); }

		const Ray& Seen_Ray() const { return *ray; }
		const Vector3d& Seen_Normal() const { return *normal; }
		/// A perturbed normal, from the scene's to the frame's.
		void Turn(Vector3d& n) const { if(seen != NULL) Bent_Turn(n); }
	private:
		struct Seen; ///< what differs from the scene's, where something does
		void Begin(const Bent_Rays *bent);
		void End();
		void Bent_Turn(Vector3d& n) const;
		const Ray *ray;
		const Vector3d *normal;
		Intersection& isect;
		DBL chord_depth; ///< the hit's depth on its chord; negative for a ray that is not bent
		Seen *seen;

		Local_Frame(const Local_Frame&);
		Local_Frame& operator=(const Local_Frame&);
};

}

#endif
