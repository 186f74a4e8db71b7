// SPDX-License-Identifier: AGPL-3.0-or-later
/// A ray through a scene with holes: straight outside the effect spheres, chord after chord inside.
///
/// trace.cpp's hooks hold a Bent_Path in each TraceRay; everything here works for one thread.
#ifndef POVRAY_BENTRAYS_H
#define POVRAY_BENTRAYS_H

#include <vector>

#include "backend/frame.h"
#include "backend/render/ray.h"
#include "backend/render/trace.h"
#include "blackhole/chords.h"

namespace pov
{

class Blackhole;
class Blackholes;
class SceneData;
struct Blackhole_Counts;
struct Bent_Segment;
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
		static void Begin_Pixel(Bent_Rays *b, DBL x, DBL y, DBL width, DBL height) { if(b != NULL) b->Begin(x, y, width, height); }
		static void End_Pixel(Bent_Rays *b) { if(b != NULL) b->End(); }
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
		blackhole::Path path;
		std::vector<Bent_Segment *> pool; ///< states, by depth of recursion
		size_t depth;
		Recorder *recorder;                ///< of the pixel in hand; NULL: not kept
};

/// One TraceRay's way. The tests for NULL are inline: they are all that a scene without a hole pays.
class Bent_Path
{
	public:
		Bent_Path(Bent_Rays *b, const Ray& ray) : bent(b), state(NULL), original(ray) { if(bent != NULL) Begin(); }
		~Bent_Path() { if(state != NULL) End(); }

		/// Whether the ray is ours; photons and subsurface rays go straight.
		bool Bends() const { return state != NULL; }
		/// The ray as given, or the chord in hand once Find_Intersection ran; the reference stays valid.
		const Ray& Chord() const { return state == NULL ? original : Bent_Chord(); }
		/// As Trace::FindIntersection, along the whole way. Depth of the intersection: along the last chord.
		bool Find_Intersection(Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		/// Whether the ray ended in a horizon: opaque black.
		bool Captured() const { return (state != NULL) && Bent_Captured(); }
		/// Length of all chords before the last, zero for a straight ray.
		DBL Travelled() const { return state == NULL ? 0.0 : Bent_Travelled(); }
		/// Fog and media of all chords before the last, back to front.
		void Compute_Volume(Colour& colour, Trace::TraceTicket& ticket) { if(state != NULL) Bent_Volume(colour, ticket); }
	private:
		const Ray& Bent_Chord() const;
		bool Bent_Captured() const;
		DBL Bent_Travelled() const;
		void Bent_Volume(Colour& colour, Trace::TraceTicket& ticket);
		void Begin();
		void End();
		bool Enter(VECTOR origin, blackhole::Vec3& direction);
		bool Straight(const VECTOR from, const blackhole::Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		size_t Next_Sphere(const VECTOR from, const blackhole::Vec3& direction, size_t left, DBL& distance) const;
		bool Through(size_t hole, VECTOR from, blackhole::Vec3& direction, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		void Emerge(const VECTOR point);
		bool End_With(const char *end, bool found);
		void Record(const VECTOR from, const VECTOR to, size_t hole, bool tested);

		Bent_Rays *bent;
		Bent_Segment *state;
		const Ray& original;

		Bent_Path(const Bent_Path&);
		Bent_Path& operator=(const Bent_Path&);
};

}

#endif
