// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/scene/gather.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <future>
#include <glob.h>
#include <regex>
#include <set>

namespace farm {
namespace {

/// The names by which the scene may have asked for a file: POV-Ray puts what it was asked for behind the folder in which it found
/// it.
std::set<std::string> asked_names(const std::string& found, const SettledScene& scene) {
	const std::vector<fs::path> folders = scene.folders();
	std::set<std::string> names;
	for (const auto& folder : folders) {
		const std::string front = (folder / "").string();
		if (found.rfind(front, 0) != 0)
			continue;
		const fs::path name = fs::path(found.substr(front.size())).lexically_normal();
		for (const auto& first : folders)
			if (fs::exists(first / name)) {
				if (fs::equivalent(first / name, found))
					names.insert(name.string());
				break;
			}
	}
	if (names.empty())
		throw Error(
			"the scene reads " + found + " by an absolute name, which workers do not have; name it relative to the scene");
	return names;
}

bool of_the_system(const std::string& name) {
	for (const char* prefix : {"/proc/", "/sys/", "/dev/", "/etc/", "/usr/lib/", "/lib/", "/usr/share/zoneinfo/"})
		if (name.rfind(prefix, 0) == 0)
			return true;
	return false;
}

/// Whether the scene's language has a radiosity block; comments and strings aside.
bool has_radiosity(const fs::path& file) {
	if (file.extension() != ".pov" && file.extension() != ".inc")
		return false;
	std::string text = read_file(file), code;
	for (size_t i = 0; i < text.size(); ++i) {
		if (text.compare(i, 2, "//") == 0) {
			i = std::min(text.find('\n', i), text.size());
		} else if (text.compare(i, 2, "/*") == 0) {
			i = std::min(text.find("*/", i + 2), text.size() - 2) + 1;
		} else if (text[i] == '"') {
			for (++i; i < text.size() && text[i] != '"'; ++i)
				i += text[i] == '\\';
		} else {
			code += text[i];
			continue;
		}
		code += ' ';
	}
	return std::regex_search(code, std::regex("\\bglobal_settings\\b")) &&
		   std::regex_search(code, std::regex("\\bradiosity\\s*\\{"));
}

std::vector<std::string> matches(const std::string& pattern, const fs::path& folder) {
	glob_t found{};
	std::vector<std::string> names;
	if (::glob((folder / pattern).c_str(), GLOB_MARK, nullptr, &found) == 0)
		for (size_t i = 0; i < found.gl_pathc; ++i)
			if (const std::string name = found.gl_pathv[i]; name.back() != '/')
				names.push_back(fs::path(name).lexically_relative(folder).string());
	::globfree(&found);
	if (names.empty())
		throw Error("--assets '" + pattern + "' matches no file in " + folder.string());
	return names;
}

} // namespace

Gathered gather(SettledScene& scene, const Trier& trier, const std::vector<std::string>& assets) {
	const fs::path folder = scene.scene.parent_path();
	scene.spec.options.push_back(ini_line({"Input_File_Name", scene.scene.filename().string()}));
	Gathered result;
	JobSpec& spec = scene.spec;
	std::set<std::string> reads;
	const int count = spec.animation ? (spec.last - spec.first) / spec.step + 1 : 1;
	const auto tell = [&](const std::string& what) {
		if (trier.doing)
			trier.doing(what);
	};
	tell(spec.animation ? "parsing the scene for the first, the middle and the last frame" : "parsing the scene");
	std::vector<std::future<Parsed>> parses; // at once: most of the time povray waits for itself
	for (const int index : std::set<int>{0, count / 2, count - 1})
		parses.push_back(std::async(std::launch::async, [&, frame = spec.frame(index)] { return parse(scene, frame, trier); }));
	for (auto& future : parses) {
		Parsed parsed = future.get();
		reads.merge(parsed.reads);
		result.parse_seconds = std::max(result.parse_seconds, parsed.seconds);
		if (spec.whole_because.empty() && parsed.said.find("An isosurface has 'evaluate'") != std::string::npos)
			spec.whole_because = "an isosurface has 'evaluate', which learns from pixel to pixel";
	}
	reads.insert(scene.scene.string());

	std::map<std::string, fs::path> files; // by the name asked for
	size_t above = 0;
	bool radiosity = false;
	for (const auto& name : reads)
		// What has no folder the scene has just written itself.
		if (fs::path(name).is_absolute() && !of_the_system(name) && fs::is_regular_file(name))
			for (const auto& asked : asked_names(name, scene))
				files.emplace(asked, fs::path(name).lexically_normal());
	for (const auto& pattern : assets)
		for (const auto& name : matches(pattern, folder))
			files.emplace(name, folder / name);
	// "../images/x.png" needs as many folders above the scene's.
	for (const auto& [name, path] : files) {
		const fs::path parts(name);
		above = std::max<size_t>(above, static_cast<size_t>(std::count(parts.begin(), parts.end(), "..")));
	}
	for (size_t i = 0; i < above; ++i)
		result.bundle.folder += i ? "/up" : "up";
	for (const auto& [name, path] : files) {
		const std::string inner = (fs::path(result.bundle.folder) / name).lexically_normal().string();
		const std::string hash = sha256_file(path);
		result.bundle.files.push_back({inner, hash, static_cast<std::int64_t>(fs::file_size(path))});
		result.sources[hash] = path;
		radiosity = radiosity || has_radiosity(path);
	}
	std::sort(
		result.bundle.files.begin(), result.bundle.files.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
	spec.bundle = result.bundle.id();
	constexpr double patience = 10;
	if (spec.whole_because.empty())
		tell("rendering a small frame, to see how long it takes");
	if (spec.whole_because.empty() && radiosity)
		result.light_seconds = start_time(scene, spec.frame(count / 2), trier, result.parse_seconds, patience);
	if (spec.whole_because.empty())
		result.frame_seconds = frame_time(scene, spec.frame(count / 2), trier, result.parse_seconds, patience);
	// The same checks as the server's, before anything is sent.
	json(result.bundle).get<Bundle>();
	return result;
}

} // namespace farm
