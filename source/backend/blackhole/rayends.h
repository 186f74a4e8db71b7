// SPDX-License-Identifier: AGPL-3.0-or-later
/// Where the rays of each pixel end, written as CSV: what a setting changes of a picture can be read from it.
/// Unlike ray paths this changes nothing about how rays are followed.
#ifndef POVRAY_RAYENDS_H
#define POVRAY_RAYENDS_H

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <boost/thread/mutex.hpp>

#include "backend/frame.h"
#include "base/povms.h"
#include "base/povmscpp.h"
#include "blackhole/vec.h"

namespace pov
{

class Blackholes;
class MessageFactory;

struct Ray_End
{
	unsigned int Level;   ///< 1 for camera rays, 2 for their reflections, ...
	float Weight;         ///< the most of the pixel's light it can carry, as POV-Ray reckons it
	const char *End;      ///< "sky", "object", "horizon", "max distance", "failed"
	ObjectPtr Object;     ///< what was hit, or NULL; -1 in the file
	blackhole::Vec3 At;   ///< scene coordinates of the hit; its direction (unit) for a ray that hit nothing; zero in a horizon
};

class Ray_Ends
{
	public:
		/// Reads `Ray_Ends`; NULL if it is not there. Throws where the file cannot be.
		static Ray_Ends *Create(POVMS_Object& options);

		/// Keeps the ends of a pixel's rays, in the order traced, those of its first sample. Thread-safe.
		void Keep(int x, int y, std::vector<Ray_End>& pixel);
		/// Numbers the scene's objects in their order, parts of CSG after what they are parts of.
		void Number(const std::vector<ObjectPtr>& objects);
		/// Writes the file: a comment for each hole, then a row for each ray. A file that cannot be written is one warning.
		void Write(const Blackholes& holes, MessageFactory& messages);
	private:
		std::string file;
		std::map<ObjectPtr, int> numbers;
		boost::mutex mutex;
		std::map<std::pair<int, int>, std::vector<Ray_End> > pixels; ///< by row, column
};

}

#endif
