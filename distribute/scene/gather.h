// SPDX-License-Identifier: AGPL-3.0-or-later
/// What a scene reads, found by parsing it: the files for the bundle.
#ifndef FARM_GATHER_H
#define FARM_GATHER_H

#include "distribute/scene/dryrun.h"

#include <map>

namespace farm {

struct Gathered {
	Bundle bundle;
	std::map<std::string, std::filesystem::path> sources; ///< where each file of the bundle is here, by its SHA-256
	double parse_seconds = 0;                             ///< the longest parse
	double light_seconds = 0;                             ///< radiosity's pretrace, of the middle frame
	double frame_seconds = 0; ///< what one core may need for a frame: the middle one's, from a small picture of it
};

/// Parses the first, the middle and the last frame, without rendering, and collects each file that was read;
/// `assets` are patterns, relative to the scene's folder, of files that other frames read. Fills in what of the job hangs on it:
/// Input_File_Name, and why frames are not cut. Throws Error with POV-Ray's own words if the scene does not parse, or if it reads
/// files by absolute names.
Gathered gather(SettledScene& scene, const Trier& trier, const std::vector<std::string>& assets);

} // namespace farm
#endif
