// SPDX-License-Identifier: AGPL-3.0-or-later
/// What a fenced program sees and may do, and the bubblewrap command line that says so. No state, no system: words in, words out.
#ifndef FARM_FENCE_H
#define FARM_FENCE_H

#include "distribute/common/process.h"

#include <filesystem>
#include <string>
#include <vector>

namespace farm {

/// The part of the file system that is seen, each thing at its own absolute path.
struct Room {
	std::vector<std::filesystem::path> reads;  ///< files and folders to read from
	std::vector<std::filesystem::path> writes; ///< folders to write to as well; they may lie within those above
	bool everything = false;                   ///< the whole file system may be read
};

/// The descriptor on which bubblewrap finds the filter of system calls.
constexpr int filter_descriptor = 3;

/// The words that run `command` in `room` with its environment and no other, without network, other processes or privileges.
std::vector<std::string> fence_words(const std::filesystem::path& bubblewrap, const Room& room, const Command& command);

} // namespace farm
#endif
