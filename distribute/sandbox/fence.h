// SPDX-License-Identifier: AGPL-3.0-or-later
/// What a fenced program sees and may do, and the bubblewrap command line that says so. No state, no system: words in, words out.
#ifndef FARM_FENCE_H
#define FARM_FENCE_H

#include "distribute/common/process.h"

#include <filesystem>
#include <string>
#include <vector>

namespace farm {

/// A file or folder, and where it is seen, an absolute path; where it is if nothing else is said.
struct Seen {
	std::filesystem::path from, at;
	Seen(const std::filesystem::path& place) : from(place), at(place) {}
	Seen(const std::filesystem::path& f, const std::filesystem::path& a) : from(f), at(a) {}
};

/// The part of the file system that is seen.
struct Room {
	std::vector<Seen> reads;  ///< files and folders to read from
	std::vector<Seen> writes; ///< folders to write to as well; they may lie within those above
	bool everything = false;  ///< the whole file system may be read; each thing is then where it is
};

/// The descriptor on which bubblewrap finds the filter of system calls.
constexpr int filter_descriptor = 3;

/// The words that run `command` in `room` with its environment and no other, without network, other processes or privileges.
std::vector<std::string> fence_words(const std::filesystem::path& bubblewrap, const Room& room, const Command& command);

} // namespace farm
#endif
