// SPDX-License-Identifier: AGPL-3.0-or-later
/// Radiosity's caches of the frames that are under way here.
#ifndef FARM_LIGHT_H
#define FARM_LIGHT_H

#include "distribute/common/files.h"
#include "distribute/protocol/messages.h"

namespace farm {

/// The first strip of a frame on this machine leaves its pretrace to the next ones, which are spared the time; their pixels are
/// the same with and without. No machine takes another's, so none can spoil it for others. Safe for several threads; goes with
/// the worker.
class LightStore {
public:
	/// In a folder of its own below `parent`. Throws Error if it cannot be made.
	explicit LightStore(const fs::path& parent) : scratch(parent) {}

	/// Puts the frame's cache to `place`; false if there is none yet.
	bool fetch(const Task& task, const fs::path& place) const;
	/// Takes what povray has written, if that is a file with something in it.
	void keep(const Task& task, const fs::path& written) const;
	/// One that povray did not like.
	void forget(const Task& task) const;

private:
	fs::path place_of(const Task& task) const;
	ScratchFolder scratch;
};

} // namespace farm
#endif
