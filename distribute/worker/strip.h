// SPDX-License-Identifier: AGPL-3.0-or-later
/// One strip, rendered by a povray behind the fence.
#ifndef FARM_STRIP_H
#define FARM_STRIP_H

#include "distribute/protocol/messages.h"
#include "distribute/sandbox/sandbox.h"
#include "distribute/worker/light.h"

#include <functional>
#include <memory>

namespace farm {

/// How povray is run here.
struct Renderer {
	std::filesystem::path povray;
	Sandbox sandbox;
	Limits limits;
	int nice = 19;
	std::shared_ptr<LightStore> light; ///< for frames with radiosity; may be null
};

struct Rendered {
	std::filesystem::path picture; ///< of the whole frame's size; empty if there is none
	Failure failure;               ///< why there is none, if povray or a limit is to blame
	double seconds = 0;
	bool given_up = false;    ///< because `give_up` said so
	bool not_started = false; ///< nobody's fault: to be tried again
};

/// `root` is the bundle's top and `folder`, in it, where the scene is; both are only read. `scratch` is an empty folder, all that
/// povray writes goes there. Asks `give_up` some times a second.
Rendered render_strip(const Renderer& renderer, const Task& task, const std::filesystem::path& root,
	const std::filesystem::path& folder, const std::filesystem::path& scratch, const std::function<bool()>& give_up);

} // namespace farm
#endif
