// SPDX-License-Identifier: AGPL-3.0-or-later
/// Runs povray behind a fence: bubblewrap, a filter of system calls, and the kernel's limits.
#ifndef FARM_SANDBOX_H
#define FARM_SANDBOX_H

#include "distribute/sandbox/fence.h"
#include "distribute/sandbox/limits.h"

#include <memory>
#include <set>

namespace farm {

class Sandbox {
public:
	/// No fence: commands run as they are, within the limits only.
	Sandbox() = default;
	/// A fence for this program, tried out. Throws Error, with what to do, if there is no bubblewrap, it does not work here, or
	/// the program's libraries cannot be told.
	explicit Sandbox(const std::filesystem::path& program);

	/// The command, one of this program's, behind the fence. What it needs to read is in the room; the program and its libraries
	/// come by themselves. Only `command.environment` gets in.
	Command fenced(const Command& command, Room room, const Limits& limits = {}) const;
	bool fences() const { return filter != nullptr; }
	/// Something of a room, at a place that is the same on each machine; where it is, if there is no fence.
	Seen placed(const std::filesystem::path& from, const std::filesystem::path& at) const { return {from, fences() ? at : from}; }

private:
	std::filesystem::path bubblewrap;
	Room program_room;
	std::set<std::filesystem::path> libraries;       ///< files and folders of them to be seen
	std::set<std::filesystem::path> library_folders; ///< to be searched
	std::shared_ptr<const int> filter;
};

/// For a scene of one's own, tried out where it lies: the fence if it works here. If it does not, the scene runs as `povray` by
/// hand would run it, and one line says so: its owner trusts it, and must not need more set up than for povray itself. `wanted`
/// is false for --no-sandbox.
Sandbox sandbox_for_own_scenes(const std::filesystem::path& program, bool wanted);

} // namespace farm
#endif
