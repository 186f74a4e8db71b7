// SPDX-License-Identifier: AGPL-3.0-or-later
/// A ray through a scene with holes: straight outside the effect spheres, chord after chord inside.
///
/// trace.cpp's hooks hold a Bent_Path in each TraceRay. bentpath.cpp has the way from sphere to sphere,
/// bentlegs.cpp what happens on each leg of it, bentsearch.cpp how hits are found, bentpieces.cpp how sooner where objects are few,
/// bentvolume.cpp what fills the space along it.
#ifndef POVRAY_BENTPATH_H
#define POVRAY_BENTPATH_H

#include "backend/blackhole/bentrays.h"
#include "backend/render/trace.h"
#include "blackhole/chords.h"

namespace pov
{

/// One TraceRay's way. The tests for NULL are inline: they are all that a scene without a hole pays.
class Bent_Path
{
	public:
		/// weight: the most of the pixel's light that the ray can carry.
		Bent_Path(Bent_Rays *b, const Ray& ray, float weight) : bent(b), state(NULL), original(ray), volume(false) { if(bent != NULL) Begin(weight); }
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
		/// Media, rainbow and fog of the whole way, as TraceRay does for a straight ray.
		void Compute_Volume(Intersection& isect, bool found, Colour& colour, Trace::TraceTicket& ticket) { if(volume) Volume_Of(isect, found, colour, ticket); }

		// For trace.cpp's own fog and rainbow: what the way before the chord in hand adds. Straight rays: no change.

		/// The share of light a fog lets through on the whole way; att: on the chord in hand, of this length.
		static DBL Fog(const Bent_Rays *b, const Ray& ray, DBL width, const FOG *fog, DBL att) { return b == NULL ? att : Bent_Fog(*b, ray, width, *fog, att); }
		/// The share a rainbow lets through up to the chord in hand, no less than its least.
		static DBL Rainbow(const Bent_Rays *b, const Ray& ray, DBL distance, DBL least) { return b == NULL ? 1.0 : Bent_Rainbow(*b, ray, distance, least); }
	private:
		const Ray& Bent_Chord() const;
		bool Bent_Captured() const;
		DBL Bent_Travelled() const;
		void Begin(float weight);
		bool Follow(Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		void End();
		bool Enter(VECTOR origin, blackhole::Vec3& direction);
		size_t Next_Sphere(const VECTOR from, const blackhole::Vec3& direction, size_t left, DBL& distance) const;
		bool End_With(const char *end, bool found);
		bool Swallowed(Intersection& isect);
		// bentvolume.cpp
		static DBL Bent_Fog(const Bent_Rays& bent, const Ray& ray, DBL width, const FOG& fog, DBL att);
		static DBL Bent_Rainbow(const Bent_Rays& bent, const Ray& ray, DBL distance, DBL least);
		void Set_Volume();
		void Volume_Of(Intersection& isect, bool found, Colour& colour, Trace::TraceTicket& ticket);
		void Take(size_t span, Intersection& isect);
		// bentlegs.cpp
		bool Straight(const VECTOR from, const blackhole::Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		bool Through(size_t hole, VECTOR from, blackhole::Vec3& direction, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		bool Search(const VECTOR from, const blackhole::Vec3& direction, DBL length, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		bool Nearest_Of(const std::vector<unsigned int>& objects, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		bool Nothing_There(const VECTOR from, const blackhole::Vec3& direction, DBL length, Intersection& isect);
		bool Nowhere(Intersection& isect);
		bool To_Sky(Intersection& isect);
		bool Only_Exit(const Blackhole& hole, VECTOR from, blackhole::Vec3& direction);
		void Leave(VECTOR from, const blackhole::Vec3& direction);
		template<typename Way> bool Ended(const Blackhole& hole, const Way& way, bool chords, bool solved, VECTOR from, blackhole::Vec3& direction, Intersection& isect);
		/// Along the whole of a walk (a Route or Chords): every chord, or arcs of so many chords first.
		template<typename Walk> bool Along(Walk& walk, size_t hole, bool emerges, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		template<typename Walk> bool Along_Chords(Walk& walk, size_t hole, bool emerges, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		template<typename Walk> bool Along_Arcs(Walk& walk, size_t hole, int chords, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		/// The same of a Route whose plane cuts few objects: pieces of so many chords, four at a time. False if nothing is hit.
		bool Along_Pieces(size_t hole, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		bool Along_Pieces(size_t hole, int first, int last, int chords, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		/// Whether all chords count, not hits alone.
		bool Every_Chord() const;
		void Skip(int chords, DBL length);
		template<typename Walk> bool Along_Chord(const Walk& walk, const blackhole::Chord& marks, const Scene_Chord& chord, const std::vector<unsigned int>& objects, size_t hole, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post, bool& found);
		bool Hit_Chord(const Scene_Chord& chord, const blackhole::Vec3& direction, DBL length, const std::vector<unsigned int>& objects, const Blackhole& hole, Intersection& isect, const RayObjectCondition& pre, const RayObjectCondition& post);
		void Pass(const VECTOR from, const blackhole::Vec3& direction, DBL length);
		void Emerge(const VECTOR point);
		void Record(const VECTOR from, const VECTOR to, size_t hole, bool tested);

		Bent_Rays *bent;
		Bent_Segment *state;
		const Ray& original;
		bool volume; ///< fog, rainbow or media: spans are kept

		Bent_Path(const Bent_Path&);
		Bent_Path& operator=(const Bent_Path&);
};

}

#endif
