// SPDX-License-Identifier: AGPL-3.0-or-later
/// The chords that were traced for a grid of pixels, written as CSV or VRML97: the debugger of everything else.
#ifndef POVRAY_RAYPATHS_H
#define POVRAY_RAYPATHS_H

#include <map>
#include <string>
#include <vector>

#include <boost/thread/mutex.hpp>

#include "base/povms.h"
#include "base/povmscpp.h"
#include "blackhole/vec.h"

namespace pov
{

class Blackholes;
class MessageFactory;

/// One ray: a light path's segment from its origin to what ended it, in scene coordinates.
struct Recorded_Ray
{
	struct Chord
	{
		blackhole::Vec3 From, To;
		int Hole;      ///< index of the hole whose sphere it lies in, -1 outside all
		bool Tested;   ///< against the scene's objects
	};
	unsigned int Level; ///< 1 for camera rays, 2 for their reflections, ...
	std::vector<Chord> Chords;
	const char *End;    ///< "sky", "object", "horizon", "max distance", "failed"
	double Drift;       ///< largest of its paths'
};

/// All rays of one pixel, in the order traced.
typedef std::vector<Recorded_Ray> Recorded_Pixel;

class Ray_Paths
{
	public:
		/// Reads `Ray_Paths` and `Ray_Paths_Grid`; NULL if no paths are wanted. Throws on an unknown ending or a bad grid.
		static Ray_Paths *Create(POVMS_Object& options);

		/// Whether a sample at column x, row y of a picture of that size is in one of the grid's pixels.
		bool Wants(DBL x, DBL y, DBL width, DBL height) const;
		/// Keeps a pixel's rays, those of its first sample. Thread-safe.
		void Keep(int x, int y, Recorded_Pixel& pixel);
		/// Writes the file. A file that cannot be written is one warning.
		void Write(const Blackholes& holes, MessageFactory& messages);
	private:
		Ray_Paths() : columns(32), rows(24) { }
		std::string Csv() const;
		std::string Vrml(const Blackholes& holes) const;

		std::string file;
		int columns, rows;
		boost::mutex mutex;
		std::map<std::pair<int, int>, Recorded_Pixel> pixels; ///< by row, column
};

}

#endif
