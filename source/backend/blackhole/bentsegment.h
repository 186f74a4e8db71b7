// SPDX-License-Identifier: AGPL-3.0-or-later
/// The state of one ray under way, shared by bentrays.cpp, bentpath.cpp, bentlegs.cpp and localframe.cpp only.
#ifndef POVRAY_BENTSEGMENT_H
#define POVRAY_BENTSEGMENT_H

#include <vector>

#include "backend/render/ray.h"
#include "backend/blackhole/rayends.h"
#include "backend/blackhole/raypaths.h"
#include "blackhole/vec.h"

namespace pov
{

/// No hole's index: outside all effect spheres.
static const size_t NO_HOLE = size_t(-1);

/// The rays of the pixel in hand, if they are to be kept.
struct Recorder
{
	int x, y;
	Recorded_Pixel rays;
};

/// Where they end, likewise.
struct End_Recorder
{
	int x, y;
	std::vector<Ray_End> rays;
};

struct Bent_Segment
{
	/// A chord, kept for fog and media.
	struct Span
	{
		VECTOR from, direction;
		DBL length;
	};

	Ray chord;               ///< the chord in hand
	blackhole::Vec3 tangent; ///< the path's at the hit, coordinates
	bool has_tangent;        ///< the hit is inside an effect sphere
	bool captured;
	bool moved;              ///< no longer on the ray's first chord
	DBL budget;              ///< the farthest the ray may go; infinite unless the caller limits it
	DBL travelled;           ///< length of the chords before the one in hand
	std::vector<Span> spans; ///< those before the chord in hand
	DBL before;              ///< length of the way before the span that is being filled
	size_t record;           ///< index in the recorder, if there is one
	unsigned int chords;
	float weight;            ///< the most of the pixel's light that it can carry
	DBL drift;
	const char *end;
};

}

#endif
