// SPDX-License-Identifier: AGPL-3.0-or-later
/// What a thread needs to bend rays, and what holes mean for straight light. The rays' ways are in bentpath.h.
#ifndef POVRAY_BENTRAYS_H
#define POVRAY_BENTRAYS_H

#include <vector>

#include "backend/frame.h"
#include "backend/render/ray.h"
#include "backend/blackhole/chordtree.h"
#include "backend/blackhole/planecut.h"
#include "blackhole/route.h"

namespace pov
{

class Blackhole;
class Blackholes;
class SceneData;
class Trace;
struct Blackhole_Counts;
struct Bent_Segment;
struct End_Recorder;
struct Recorder;

/// A thread's tools for bending rays: one for each Trace object; none in scenes without a hole.
class Bent_Rays
{
	public:
		/// NULL if the scene has neither holes nor ray paths to write.
		static Bent_Rays *Create(const SceneData& scene, Trace& trace);
		~Bent_Rays();

		// The hooks call these with what may be NULL, and then they do nothing.

		/// A camera ray of this pixel follows; decides whether its paths are kept.
		static void Begin_Pixel(Bent_Rays *b, DBL x, DBL y, DBL width, DBL height) { if((b != NULL) && b->keeps) b->Begin(x, y, width, height); }
		static void End_Pixel(Bent_Rays *b) { if((b != NULL) && b->keeps) b->End(); }
		/// Whether a hole's horizon is between a point and its light (which goes straight).
		static bool Blocks(const Bent_Rays *b, const Ray& light_ray, DBL depth) { return (b != NULL) && b->Blocks_Light(light_ray, depth); }
		/// A ray's direction from coordinates to the static frame at its origin, and back.
		static void To_Static(const Bent_Rays *b, Ray& ray) { if(b != NULL) b->Turn(ray, true); }
		static void To_Coordinate(const Bent_Rays *b, Ray& ray) { if(b != NULL) b->Turn(ray, false); }
	private:
		friend class Bent_Path;
		friend class Local_Frame;
		/// The way of the ray whose hit is being shaded, or NULL if that ray is not bent.
		const Bent_Segment *Shaded(const Ray& ray) const;
		Bent_Rays(const SceneData& scene, Trace& trace);
		void Begin(DBL x, DBL y, DBL width, DBL height);
		void End();
		bool Blocks_Light(const Ray& ray, DBL length) const;
		void Turn(Ray& ray, bool to_static) const;

		const SceneData& scene;
		Blackholes& holes;
		Trace& trace;
		Blackhole_Counts& counts;
		blackhole::Route route;
		blackhole::Path path; ///< of rays that the atlas does not have
		Plane_Cut cut;        ///< by the plane of the route in hand
		std::vector<unsigned int> candidates, fewer, chosen; ///< of the arc, of a part of it, and of the chord in hand
		std::vector<Bent_Segment *> pool; ///< states, by depth of recursion
		size_t depth;
		const bool fills;                  ///< the space has fog, a rainbow or an atmosphere
		const bool keeps;                  ///< paths or ends are kept, of some pixels
		Recorder *recorder;                ///< of the pixel in hand; NULL: not kept
		End_Recorder *ends;                ///< likewise
};

}

#endif
