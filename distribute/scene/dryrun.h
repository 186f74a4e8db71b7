// SPDX-License-Identifier: AGPL-3.0-or-later
/// A scene tried out before it becomes a job.
#ifndef FARM_DRYRUN_H
#define FARM_DRYRUN_H

#include "distribute/sandbox/sandbox.h"
#include "distribute/scene/settle.h"

#include <atomic>
#include <functional>
#include <set>

namespace farm {

struct Parsed {
	std::set<std::string> reads; ///< the files that were read, as POV-Ray named them
	std::string said;            ///< what povray printed, its lines' breaks and blanks as single blanks
	double seconds = 0;
};

/// The povray that tries scenes out, and its fence. A scene on its owner's machine reads what its owner may read, as with povray
/// by hand: what it names goes along to the farm, and one that would be missed there is to be named here. It changes nothing:
/// what it writes goes to a folder that is removed.
struct Trier {
	std::filesystem::path povray;
	Sandbox sandbox;
	const std::atomic<bool>* stop = nullptr;            ///< once it is true, what runs is ended, and Stopped thrown
	std::function<void(const std::string&)> doing = {}; ///< is told what is tried now, if there is one
};

/// Parses one frame and renders one pixel of it without its textures' cost. Throws Error with POV-Ray's own words if it does not
/// parse.
Parsed parse(const SettledScene& scene, int frame, const Trier& trier);

/// What it takes before the first pixel, without parsing: photons, and radiosity's pretrace of the whole frame. Given up after
/// `patience` seconds. Seconds.
double start_time(const SettledScene& scene, int frame, const Trier& trier, double parse_seconds, double patience);

/// What one core needs for a frame, without parsing: from a picture of an eighth of the width and height, which is given up after
/// `patience` seconds (it then needs at least what comes of those). Seconds.
double frame_time(const SettledScene& scene, int frame, const Trier& trier, double parse_seconds, double patience);

} // namespace farm
#endif
