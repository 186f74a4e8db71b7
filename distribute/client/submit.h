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
	SettledScene scene; ///< its spec is complete once it has been tried out
	Gathered files;
	std::filesystem::path povray;
	Sandbox sandbox;            ///< to try it out in
	std::filesystem::path film; ///< where the film is to go; empty: there is none
};

/// What the words and the INI files say, and says what is left out. Throws Error.
Prepared prepare(const Arguments& arguments);
/// Parses the scene, gathers its files, and cuts its frames up for about so many slots. Throws Error; Stopped once `stop` is
/// true.
void try_out(Prepared& prepared, const Arguments& arguments, int slots, const std::atomic<bool>* stop = nullptr);

/// Sends what the server lacks, then the job; returns its number.
std::int64_t send_job(Client& client, const Prepared& prepared);

} // namespace farm
#endif
