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

/// What a surface sees of a bent ray that hit it: direction and normal in the static frame there.
class Local_Frame
{
	public:
		Local_Frame(const Bent_Rays *bent, const Ray& ray, const Vector3d& normal, const VECTOR point);
		~Local_Frame() { delete bentray; }

		const Ray& Seen_Ray() const { return bentray != NULL ? *bentray : ray; }
		const Vector3d& Seen_Normal() const { return bentray != NULL ? bentnormal : normal; }
		/// A perturbed normal, from the scene's to the frame's.
		void Turn(Vector3d& n) const;
	private:
		const Ray& ray;
		const Vector3d& normal;
		const Blackhole *hole;
		blackhole::Vec3 x;
		Ray *bentray;
		Vector3d bentnormal;

		Local_Frame(const Local_Frame&);
		Local_Frame& operator=(const Local_Frame&);
};

}

#endif
