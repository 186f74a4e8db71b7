// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/control/messagefactory.h"
#include "backend/blackhole/blackhole.h"
#include "backend/blackhole/counts.h"
#include "backend/blackhole/reach.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

static POV_ULONG Blackhole_Counts::* const SUMS[] = {
	&Blackhole_Counts::Entered, &Blackhole_Counts::Captured, &Blackhole_Counts::Closed, &Blackhole_Counts::Charted, &Blackhole_Counts::Paths,
	&Blackhole_Counts::Steps, &Blackhole_Counts::Filled, &Blackhole_Counts::Tested,
	&Blackhole_Counts::Skipped, &Blackhole_Counts::Object_Tests, &Blackhole_Counts::Hits, &Blackhole_Counts::Nudged,
	&Blackhole_Counts::Failed, &Blackhole_Counts::Exhausted, &Blackhole_Counts::Drifted, &Blackhole_Counts::Trapped,
	&Blackhole_Counts::Origins_Inside, &Blackhole_Counts::Undirected };

Blackhole_Counts::Blackhole_Counts() :
	Most_Chords(0), Most_Steps(0), Most_Swept(0.0), Drift(0.0)
{
	for(size_t i = 0; i < sizeof(SUMS) / sizeof(*SUMS); i++)
		this->*SUMS[i] = 0;
}

void Blackhole_Counts::Add(const Blackhole_Counts& other)
{
	for(size_t i = 0; i < sizeof(SUMS) / sizeof(*SUMS); i++)
		this->*SUMS[i] += other.*SUMS[i];
	Most_Chords = max(Most_Chords, other.Most_Chords);
	Most_Steps = max(Most_Steps, other.Most_Steps);
	Most_Swept = max(Most_Swept, other.Most_Swept);
	Drift = max(Drift, other.Drift);
	By_Shell.resize(max(By_Shell.size(), other.By_Shell.size()));
	for(size_t h = 0; h < other.By_Shell.size(); h++)
	{
		By_Shell[h].resize(max(By_Shell[h].size(), other.By_Shell[h].size()));
		for(size_t i = 0; i < other.By_Shell[h].size(); i++)
			By_Shell[h][i] += other.By_Shell[h][i];
	}
}

void Blackhole_Counts::Add_Tested(size_t hole, const Shells& shells, DBL nearest, DBL farthest)
{
	if(By_Shell.size() <= hole)
		By_Shell.resize(hole + 1);
	const std::vector<std::pair<DBL, DBL> >& list = shells.List();
	By_Shell[hole].resize(list.size());
	// Merged shells are in order, and apart.
	size_t first = 0, last = list.size();
	while(first < last)
	{
		const size_t middle = (first + last) / 2;
		if(list[middle].second < nearest)
			first = middle + 1;
		else
			last = middle;
	}
	if((first < list.size()) && (list[first].first <= farthest))
		By_Shell[hole][first]++;
}

// The lines of one hole's shells: those of the most chords, and what is left.
static std::string Of_Shells(const std::vector<POV_ULONG>& tested, const Shells& shells, const std::string& hole)
{
	static const size_t MOST = 6;
	std::vector<POV_ULONG> sorted(tested);
	std::sort(sorted.rbegin(), sorted.rend());
	const POV_ULONG least = sorted.size() > MOST ? sorted[MOST] + 1 : 0;
	std::string lines;
	char text[256], farthest[40];
	double rest = 0.0;
	int others = 0;
	for(size_t i = 0; i < tested.size(); i++)
	{
		const std::pair<DBL, DBL>& shell = shells.List()[i];
		if(tested[i] < least)
		{
			rest += double(tested[i]);
			others++;
			continue;
		}
		snprintf(farthest, sizeof farthest, shell.second < 1e6 ? "to %.4g" : "on", shell.second);
		snprintf(text, sizeof text, "Tested at Radii:    %15.0f   From %.4g %s Rs", double(tested[i]), shell.first, farthest);
		lines += text + hole + "\n";
	}
	if(others > 0)
	{
		snprintf(text, sizeof text, "Tested at Radii:    %15.0f   In %d shells more", rest, others);
		lines += text + hole + "\n";
	}
	return lines;
}

std::string Blackhole_Counts::Text(const std::vector<Blackhole *>& holes, const std::vector<Shells>& shells) const
{
	const double entered = max(1.0, double(Entered)), paths = max(1.0, double(Paths)), chords = double(Tested) + double(Skipped);
	char text[1024];
	snprintf(text, sizeof text,
	         "Bent Rays:          %15.0f   Captured:        %15.0f\n"
	         "Closed Form Alone:  %15.0f   Charted Orbits:  %15.0f\n"
	         "Paths Followed:     %15.0f   Steps:           %15.0f\n"
	         "Steps Per Path:     %15.2f   Most Steps:      %15u\n"
	         "Chords:             %15.0f   Per Ray:         %9.2f (most %u)\n"
	         "Chords Tested:      %15.0f   Skipped:         %15.0f\n"
	         "Object Tests:       %15.0f   Hits:            %15.0f\n"
	         "Most Turns:         %15.2f   Largest Drift:   %15.2g\n",
	         double(Entered), double(Captured), double(Closed), double(Charted),
	         double(Paths), double(Steps), double(Steps) / paths, Most_Steps,
	         chords, chords / entered, Most_Chords,
	         double(Tested), double(Skipped), double(Object_Tests), double(Hits), Most_Swept / (2.0 * M_PI), Drift);
	std::string lines(text);
	for(size_t h = 0; h < By_Shell.size(); h++)
	{
		snprintf(text, sizeof text, ", hole at <%g,%g,%g>", holes[h]->Center[X], holes[h]->Center[Y], holes[h]->Center[Z]);
		lines += Of_Shells(By_Shell[h], shells[h], holes.size() > 1 ? text : "");
	}
	if(Filled > 0)
	{
		snprintf(text, sizeof text, "Through Media, Fog: %15.0f\n", double(Filled));
		lines += text;
	}
	if(Nudged > 0)
	{
		snprintf(text, sizeof text, "Beside Critical b:  %15.0f\n", double(Nudged));
		lines += text;
	}
	return lines;
}

void Blackhole_Counts::Warn(MessageFactory& messages) const
{
	if(Failed > 0)
		messages.Warning(1, "%.0f bent ray(s) could not be followed to the end (their b is within rounding of the critical one); they show the sky in their last direction.", double(Failed));
	if(Exhausted > 0)
		messages.Warning(1, "%.0f bent ray(s) ran out of steps: their tolerance is more than their method can keep. They show the sky in their last direction; method \"exact\" needs no steps.", double(Exhausted));
	if(Drifted > 0)
		messages.Warning(1, "%.0f bent ray(s) lost more energy than their tolerance allows (the most: %g); method \"exact\" loses none.", double(Drifted), Drift);
	if(Trapped > 0)
		messages.Warning(1, "%.0f ray(s) went from hole to hole a thousand times; they are black, as if captured.", double(Trapped));
	if(Undirected > 0)
		messages.Warning(1, "%.0f ray(s) had no direction that is a number; they are black. Look for a normal or a camera that divides by zero.", double(Undirected));
	if(Origins_Inside > 0)
		messages.Warning(1, "%.0f camera ray(s) started at or inside the horizon, where no static observer is; they are black. camera \"falling\" can look from there.", double(Origins_Inside));
}

}
