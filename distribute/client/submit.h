// SPDX-License-Identifier: AGPL-3.0-or-later
/// A scene becomes a job, here and on the server.
#ifndef FARM_SUBMIT_H
#define FARM_SUBMIT_H

#include "distribute/common/arguments.h"
#include "distribute/http/client.h"
#include "distribute/scene/gather.h"

namespace farm {

/// The options of `submit` and `render` that say how a scene is rendered.
extern const std::vector<Option> scene_options;

struct Prepared {
	SettledScene scene; ///< its spec is complete
	Gathered files;
	Sandbox sandbox;            ///< that it was tried out in
	std::filesystem::path film; ///< where the film is to go; empty: there is none
};

/// Reads the scene, parses it once, and cuts it up for about so many slots. Says what is left out. Throws Error.
Prepared prepare(const Arguments& arguments, int slots);

/// Sends what the server lacks, then the job; returns its number.
std::int64_t send_job(Client& client, const Prepared& prepared);

} // namespace farm
#endif
