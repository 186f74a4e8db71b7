// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/sandbox/sandbox.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"
#include "distribute/sandbox/filter.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>
#include <unistd.h>

namespace farm {
namespace {

// A scene can ask whether a file exists: where the program lies here, and what else is installed, is not for its pictures to
// show.
const fs::path program_place = "/program";

fs::path find_bubblewrap() {
	const char* path = std::getenv("PATH");
	std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
	for (std::string folder; std::getline(folders, folder, ':');)
		if (const fs::path place = fs::path(folder) / "bwrap"; place.is_absolute() && ::access(place.c_str(), X_OK) == 0)
			return place;
	throw Error(
		"there is no bubblewrap to fence strangers' scenes with: install it (Debian's bubblewrap), or say --no-sandbox and "
		"trust whoever submits");
}

std::string output_of(Command command, int& code) {
	const ScratchFolder scratch(fs::temp_directory_path());
	command.log = scratch.path() / "log";
	code = run(command);
	return fs::exists(command.log) ? read_file(command.log) : "";
}

bool within(const fs::path& path, const fs::path& folder) {
	const fs::path rest = path.lexically_relative(folder);
	return !rest.empty() && *rest.begin() != "..";
}

/// What a program loads, as ldd tells it.
struct Loaded {
	std::set<fs::path> libraries; ///< looked for by name
	std::set<fs::path> paths;     ///< the dynamic loader, and whatever else must be where it is
};

Loaded loaded_by(const fs::path& program) {
	Command ldd;
	ldd.words = {"ldd", program.string()};
	ldd.environment = {{"LC_ALL", "C"}};
	int code = 0;
	std::istringstream lines(output_of(ldd, code));
	Loaded found;
	for (std::string line; std::getline(lines, line);) {
		const size_t from = line.find('/'), to = line.find(" (0x");
		if (from != std::string::npos && to != std::string::npos && from < to) {
			const bool by_name = line.find("=>") < from;
			(by_name ? found.libraries : found.paths).insert(fs::path(line.substr(from, to - from)).lexically_normal());
		}
		if (line.find("=> not found") != std::string::npos)
			throw Error(program.string() + " lacks a library: " + line.substr(line.find_first_not_of(" \t")));
	}
	if (code != 0 || found.libraries.empty())
		throw Error(program.string() +
					" is no program with libraries that ldd can tell, so it cannot be fenced; give povray itself, "
					"or say --no-sandbox");
	return found;
}

} // namespace

Sandbox::Sandbox(const fs::path& program) : bubblewrap(find_bubblewrap()) {
	program_room.reads.emplace_back(program, program_place);
	const Loaded loaded = loaded_by(program);
	for (const auto& path : loaded.paths)
		program_room.reads.emplace_back(path);
	for (const auto& library : loaded.libraries) {
		library_folders.insert(library.parent_path());
		// The system's folders of libraries have no secrets, and a few mounts cost less than fifty.
		if (!within(library, "/usr") && !within(library, "/lib") && !within(library, "/lib64"))
			libraries.insert(library);
	}
	for (const auto& folder : library_folders) {
		const auto holds = [&](const fs::path& other) { return other != folder && within(folder, other); };
		const bool inside = std::any_of(library_folders.begin(), library_folders.end(), holds);
		const bool systems = within(folder, "/usr") || within(folder, "/lib") || within(folder, "/lib64");
		if (systems && !inside)
			libraries.insert(folder);
	}
	filter = std::shared_ptr<const int>(new int(make_filter()), [](const int* d) {
		::close(*d);
		delete d;
	});
	Command trial;
	trial.words = {program.string(), "--version"};
	trial.environment = {{"HOME", "/"}};
	int code = 0;
	const std::string said = output_of(fenced(trial, {}), code);
	if (code != 0 && (said.empty() || said.find("bwrap: ") != std::string::npos))
		throw Error("bubblewrap does not work here (" + said.substr(0, said.find('\n')) +
					"): let users make user namespaces (sysctl kernel.unprivileged_userns_clone, or the container's profile), or "
					"say --no-sandbox and trust whoever submits");
}

Command Sandbox::fenced(const Command& command, Room room, const Limits& limits) const {
	Command whole = command;
	whole.limits = kernel_limits(limits);
	if (!fences())
		return whole;
	if (!room.everything) {
		room.reads.insert(room.reads.end(), program_room.reads.begin(), program_room.reads.end());
		const fs::path hidden = "/" + random_hex(16); // no scene can guess that, nor list a folder
		for (const auto& thing : libraries)
			room.reads.emplace_back(thing, hidden / thing.relative_path());
		std::string& search = whole.environment["LD_LIBRARY_PATH"];
		for (const auto& folder : library_folders)
			search += (search.empty() ? "" : ":") + (hidden / folder.relative_path()).string();
		whole.words.at(0) = program_place;
	}
	whole.words = fence_words(bubblewrap, room, whole);
	// What is said of the inside is not for bubblewrap itself.
	whole.environment.clear();
	whole.folder.clear();
	whole.opened[filter_descriptor] = "/proc/self/fd/" + std::to_string(*filter);
	return whole;
}

Sandbox sandbox_for_own_scenes(const fs::path& program, bool wanted) {
	if (!wanted)
		return {};
	try {
		return Sandbox(program);
	} catch (const Error& e) {
		say(std::string(e.what()) + "; as it is your own scene, it goes on without a fence");
		return {};
	}
}

} // namespace farm
