// SPDX-License-Identifier: AGPL-3.0-or-later
/// From a scene and POV-Ray's words to a job: everything an INI file may say is settled here, at submit; workers read no INI of
/// their own.
#ifndef FARM_SETTLE_H
#define FARM_SETTLE_H

#include "distribute/protocol/messages.h"
#include "distribute/scene/ini.h"

namespace farm {

/// What the farm's own options say on top of POV-Ray's.
struct Wishes {
	std::string frames; ///< "A-B" or "A"; empty: all
	std::string size;   ///< "WxH"
	std::string format; ///< "png" or "exr"
};

struct SettledScene {
	JobSpec spec;                                 ///< all but bundle and strip_rows
	std::filesystem::path scene;                  ///< the .pov file
	std::vector<std::filesystem::path> libraries; ///< where POV-Ray looks, in order, after the scene's own folder
	std::filesystem::path output;                 ///< the folder for the pictures; empty: the one we are in
	std::vector<std::string> remarks;             ///< what of the words is left out, and why; one line each

	/// Where POV-Ray looks for files, in order.
	std::vector<std::filesystem::path> folders() const;
};

/// `words`: the .ini or .pov first, then POV-Ray's own words in order. Reads the povray.ini that POV-Ray would read (POVINI,
/// ./povray.ini, the user's, the system's). Throws Error with one line for what is missing, malformed or impossible.
SettledScene settle(const std::vector<std::string>& words, const Wishes& wishes);

} // namespace farm
#endif
