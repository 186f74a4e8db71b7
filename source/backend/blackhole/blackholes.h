// SPDX-License-Identifier: AGPL-3.0-or-later
/// All holes of a scene, what of the scene is in their reach, and what tracing around them amounted to.
#ifndef POVRAY_BLACKHOLES_H
#define POVRAY_BLACKHOLES_H

#include <set>
#include <string>
#include <vector>

#include <boost/scoped_ptr.hpp>
#include <boost/thread/mutex.hpp>

#include "base/povms.h"
#include "base/povmscpp.h"
#include "backend/blackhole/blackhole.h"
#include "backend/blackhole/chordtree.h"
#include "backend/blackhole/counts.h"
#include "backend/blackhole/overrides.h"
#include "backend/blackhole/planecut.h"
#include "backend/blackhole/reach.h"
#include "blackhole/atlas.h"

namespace pov
{

class MessageFactory;
class Ray_Ends;
class Ray_Paths;
class SceneData;
class TraceThreadData;

class Blackholes
{
	public:
		explicit Blackholes(POVMS_Object& options);
		~Blackholes();

		/// Whether the scene's holes are wanted (`Blackhole=off` gives the hole-free twin).
		bool Enabled() const { return enabled; }
		/// What the INI keys say of every hole.
		const Hole_Overrides& Overrides() const { return overrides; }
		/// Takes the hole over. It is checked by the parser before.
		void Add(Blackhole *hole);
		/// The first hole whose effect sphere overlaps, or NULL.
		const Blackhole *Overlapping(const Blackhole& hole) const;
		const std::vector<Blackhole *>& Holes() const { return holes; }
		/// Whether rays need us at all: holes to bend them, paths or ends to be written.
		bool Active() const;

		/// After parsing: finds what is within reach, says so, and warns of what straddles the horizon.
		/// Returns the message's text.
		std::string Prepare(const SceneData& scene, TraceThreadData *thread, MessageFactory& messages);
		/// The most any object's code is blind for after a ray's start, scene units.
		DBL Blind() const { return blind; }
		/// The most any object's hits are off.
		DBL Vague() const { return vague; }
		/// Whether there is something to hit that is not within reach of every hole.
		bool Far_Objects() const { return far_objects; }
		const Shells& Shells_Of(size_t hole) const { return shells[hole]; }
		/// The orbits around a hole, charted for its settings.
		const blackhole::Atlas& Atlas_Of(size_t hole) const { return atlases[hole]; }
		/// Whether there is one hole and nothing to hit.
		bool Only_Sky() const { return tree.Empty() && (holes.size() == 1); }
		/// The objects by place, and the radii around a hole at which each may be hit.
		const Chord_Tree& Tree() const { return tree; }
		const std::vector<std::pair<DBL, DBL> >& Radii_Of(size_t hole) const { return radii[hole]; }

		/// The objects around a hole, for rays in a plane through its centre.
		const Few_Objects& Few_Of(size_t hole) const { return few[hole]; }

		/// The objects that reach out of all effect spheres: what a straight leg may hit.
		const std::vector<unsigned int>& Outside() const { return outside; }

		/// The hole in whose effect sphere the point lies, or NULL.
		const Blackhole *At(const VECTOR p) const
		{
			for(size_t i = 0; i < holes.size(); i++)
				if(holes[i]->Reaches(p))
					return holes[i];
			return NULL;
		}
		/// The hole with a falling camera, or NULL.
		const Blackhole *Falling() const { return falling; }

		/// Counts of a thread that begins; owned here, valid as long as the scene.
		Blackhole_Counts *New_Counts();
		/// The statistics block's lines; empty without holes.
		void Get_Statistics(POVMS_Object& stats);
		/// At the end of a view: writes the ray paths and ends, and warns of what went wrong, by name and number.
		void Finish(MessageFactory& messages);

		/// `Sample_Blocks`: adds to the list the blocks that are not rendered, of so many in all. The one that is stands anywhere
		/// among its N, the same in each run, so that columns of a picture are met alike. Whether the list counts from the first
		/// pass on; false without the option. Throws if it is no number.
		static bool Sample_Blocks(POVMS_Object& options, const SceneData& scene, unsigned int blocks, std::set<unsigned int>& skipped);

		Ray_Paths *Paths() const { return paths.get(); }
		Ray_Ends *Ends() const { return ends.get(); }
	private:
		Blackhole_Counts Sum();

		bool enabled;
		Hole_Overrides overrides;
		std::vector<Blackhole *> holes;
		std::vector<Shells> shells;
		std::vector<blackhole::Atlas> atlases;
		Chord_Tree tree;
		std::vector<std::vector<std::pair<DBL, DBL> > > radii;
		std::vector<Few_Objects> few;
		std::vector<unsigned int> outside;
		DBL blind, vague;
		bool far_objects;
		const Blackhole *falling;
		boost::scoped_ptr<Ray_Paths> paths;
		boost::scoped_ptr<Ray_Ends> ends;
		boost::mutex mutex;
		std::vector<Blackhole_Counts *> counts;

		Blackholes(const Blackholes&);
		Blackholes& operator=(const Blackholes&);
};

}

#endif
