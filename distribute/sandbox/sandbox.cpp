// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/sandbox/sandbox.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/sandbox/filter.h"

#include <cstdlib>
#include <set>
#include <sstream>
#include <unistd.h>

namespace farm {
namespace {

// A scene can ask whether a file exists: where the program lies here is not for its pictures to show.
const fs::path program_place = "/program", libraries_place = "/libraries";

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

/// The libraries a program loads, as ldd tells them.
std::set<fs::path> libraries_of(const fs::path& program) {
	Command ldd;
	ldd.words = {"ldd", program.string()};
	ldd.environment = {{"LC_ALL", "C"}};
	int code = 0;
	std::istringstream lines(output_of(ldd, code));
	std::set<fs::path> found;
	for (std::string line; std::getline(lines, line);) {
		const size_t from = line.find('/'), to = line.find(" (0x");
		if (from != std::string::npos && to != std::string::npos && from < to)
			found.insert(fs::path(line.substr(from, to - from)).lexically_normal());
		if (line.find("=> not found") != std::string::npos)
			throw Error(program.string() + " lacks a library: " + line.substr(line.find_first_not_of(" \t")));
	}
	if (code != 0 || found.empty())
		throw Error(program.string() +
					" is no program with libraries that ldd can tell, so it cannot be fenced; give povray itself, "
					"or say --no-sandbox");
	return found;
}

} // namespace

Sandbox::Sandbox(const fs::path& program) : bubblewrap(find_bubblewrap()) {
	std::set<fs::path> folders;
	program_room.reads.emplace_back(program, program_place);
	for (const auto& library : libraries_of(program))
		// The system's folders of libraries have no secrets, and a few mounts cost less than fifty.
		if (within(library, "/usr") || within(library, "/lib") || within(library, "/lib64"))
			folders.insert(library.parent_path());
		else
			program_room.reads.emplace_back(library, libraries_place / library.filename());
	library_folders = libraries_place;
	for (const auto& folder : folders) {
		library_folders += ":" + folder.string();
		bool inside = false;
		for (const auto& other : folders)
			inside = inside || (other != folder && within(folder, other));
		if (!inside)
			program_room.reads.emplace_back(folder);
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
		whole.environment["LD_LIBRARY_PATH"] = library_folders;
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
