// SPDX-License-Identifier: AGPL-3.0-or-later
/// What tracing around holes amounted to: counted by each thread, told in the statistics block and in warnings at the end.
#ifndef POVRAY_BLACKHOLE_COUNTS_H
#define POVRAY_BLACKHOLE_COUNTS_H

#include <string>
#include <vector>

#include "backend/frame.h"

namespace pov
{

class Blackhole;
class MessageFactory;
class Shells;

/// One thread's counts, summed when the picture is done.
struct Blackhole_Counts
{
	POV_ULONG Entered, Captured;   ///< passages of an effect sphere; those that ended in a horizon
	POV_ULONG Closed, Charted, Paths; ///< passages by the closed form alone, along a charted orbit, and those whose path was followed
	POV_ULONG Steps;               ///< nodes of all paths, but the first of each
	POV_ULONG Filled;              ///< passages with fog, rainbow or media along them
	POV_ULONG Tested, Skipped;     ///< chords
	POV_ULONG Object_Tests, Hits;  ///< of single objects on single chords
	POV_ULONG Nudged;
	// What went wrong.
	POV_ULONG Failed, Exhausted, Drifted, Trapped, Origins_Inside, Undirected;
	unsigned int Most_Chords, Most_Steps;
	DBL Most_Swept; ///< radians
	DBL Drift;
	/// Chords tested by the shell they are in: by hole, then by Shells::List(). Only as long as what is counted.
	std::vector<std::vector<POV_ULONG> > By_Shell;

	Blackhole_Counts();
	void Add(const Blackhole_Counts& other);
	/// A chord between these radii was tested; the first shell it reaches into has it.
	void Add_Tested(size_t hole, const Shells& shells, DBL nearest, DBL farthest);
	/// The statistics block's lines.
	std::string Text(const std::vector<Blackhole *>& holes, const std::vector<Shells>& shells) const;
	/// One warning for each thing that went wrong, with its number.
	void Warn(MessageFactory& messages) const;
};

}

#endif
