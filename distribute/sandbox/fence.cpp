// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/sandbox/fence.h"

namespace farm {

std::vector<std::string> fence_words(const std::filesystem::path& bubblewrap, const Room& room, const Command& command) {
	// No --new-session: where the kernel groups what it schedules by session, niceness means nothing outside one's own, and a
	// render would take half of a machine that somebody uses. The filter forbids to type into the terminal instead.
	std::vector<std::string> words = {bubblewrap.string(), "--unshare-all", "--cap-drop", "ALL", "--die-with-parent", "--seccomp",
		std::to_string(filter_descriptor)};
	const auto add = [&](const char* how, const Seen& thing) {
		// In the whole file system a path may lead over links, which bubblewrap must not make folders of.
		const auto place = room.everything ? std::filesystem::weakly_canonical(thing.from) : thing.at;
		words.insert(words.end(), {how, thing.from.string(), place.string()});
	};
	if (room.everything)
		add("--ro-bind", Seen("/"));
	for (const auto& thing : room.reads)
		add("--ro-bind", thing);
	for (const auto& thing : room.writes)
		add("--bind", thing);
	// No /proc, which tells of the machine and which some containers do not give away; of /dev what the C library may open.
	add("--dev-bind", Seen("/dev/null"));
	words.insert(words.end(), {"--remount-ro", "/", "--clearenv"});
	for (const auto& [name, value] : command.environment)
		words.insert(words.end(), {"--setenv", name, value});
	if (!command.folder.empty())
		words.insert(words.end(), {"--chdir", command.folder.string()});
	words.push_back("--");
	words.insert(words.end(), command.words.begin(), command.words.end());
	return words;
}

} // namespace farm
