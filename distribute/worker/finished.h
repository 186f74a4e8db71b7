// SPDX-License-Identifier: AGPL-3.0-or-later
#ifndef FARM_WORKER_FINISHED_H
#define FARM_WORKER_FINISHED_H

#include "distribute/worker/worker.h"

namespace farm {

struct Worker::Finished {
	Finished(const Task& t, const fs::path& folder) : task(t), scratch(folder) {}
	const Task task;
	const ScratchFolder scratch; ///< where the picture is
	Rendered rendered;
};

} // namespace farm
#endif
