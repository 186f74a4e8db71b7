// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/scene/dryrun.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/render/povray.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <sstream>

namespace farm {
namespace {

using Clock = std::chrono::steady_clock;

fs::path reads_library() {
	const fs::path here = program_folder();
	for (const char* place : {"bhfarm-reads.so", "../lib/bhfarm/bhfarm-reads.so"})
		if (fs::exists(here / place))
			return (here / place).lexically_normal();
	throw Error("bhfarm-reads.so is missing beside bhfarm; build or install again");
}

bool plain(const fs::path& name) {
	const std::string text = name.string();
	return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 128; });
}

/// POV-Ray opens no file whose name has other letters than ASCII's: a folder that has gets another name in the scratch folder.
fs::path plain_name(const fs::path& folder, const fs::path& scratch, size_t number) {
	if (plain(folder))
		return folder;
	const fs::path link = scratch / ("folder" + std::to_string(number));
	if (!fs::is_symlink(link))
		fs::create_directory_symlink(folder, link);
	return link;
}

/// The scene, with everything said about it so far, behind the fence in a folder of its own.
Command scene_command(const SettledScene& scene, std::string ini, const Trier& trier, const fs::path& scratch,
	const std::map<std::string, std::string>& environment = {}) {
	if (!plain(scene.scene.filename()))
		throw Error("POV-Ray cannot open " + scene.scene.string() + ": give it a name of ASCII letters alone");
	const std::vector<fs::path> folders = scene.folders();
	for (size_t i = 0; i < folders.size(); ++i)
		ini += scene_in(plain_name(folders[i], scratch, i));
	write_scratch(scratch / "dry.ini", ini + "Output_To_File=Off\n");
	const fs::path here = scratch / "here";
	fs::create_directory(here);
	Command command = povray_command(trier.povray, scratch / "dry.ini", here);
	command.folder = here;
	command.log = scratch / "log";
	command.environment.insert(environment.begin(), environment.end());
	return trier.sandbox.fenced(command, {{}, {scratch}, true});
}

std::string flat(const std::string& text) {
	std::string line;
	for (const char c : text)
		if (const char d = c == '\n' || c == '\r' || c == '\t' ? ' ' : c; d != ' ' || (!line.empty() && line.back() != ' '))
			line += d;
	return line;
}

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// 1 would mean all of them.
std::string one_pixel(const JobSpec& spec, int frame) {
	std::string ini = povray_ini(spec, frame) + "Antialias=Off\n";
	if (spec.height > 1)
		ini += "Start_Row=" + std::to_string(spec.height) + "\n";
	if (spec.width > 1)
		ini += "Start_Column=" + std::to_string(spec.width) + "\n";
	return ini;
}

/// How long it takes beyond parsing; ended after `patience` seconds of that.
double timed(const Command& command, const Trier& trier, double parse_seconds, double patience) {
	const auto start = Clock::now();
	Process process(command);
	while (!process.over(0.05) && since(start) < parse_seconds + patience)
		if (trier.stop && *trier.stop)
			throw Stopped();
	process.signal(SIGKILL);
	process.over(-1);
	return std::max(0.0, since(start) - parse_seconds);
}

} // namespace

Parsed parse(const SettledScene& scene, int frame, const Trier& trier) {
	const ScratchFolder scratch(fs::temp_directory_path());
	const fs::path list = scratch.path() / "reads";
	const std::string ini = one_pixel(scene.spec, frame) + "Quality=0\n";
	const Command command =
		scene_command(scene, ini, trier, scratch.path(), {{"LD_PRELOAD", reads_library()}, {"BHFARM_READS", list}});
	const auto start = Clock::now();
	const auto [code, log] = run_povray(command, trier.stop);
	Parsed parsed;
	parsed.seconds = since(start);
	if (code != 0) {
		std::string why = error_line(log, code, plain_name(scene.scene.parent_path(), scratch.path(), 0));
		// POV-Ray does not say which it did not like.
		if (why.rfind("Failed to parse", 0) == 0)
			for (const auto& option : scene.spec.options)
				why += (why.back() == 'e' ? ": one of " : ", ") + option;
		throw Error(why);
	}
	parsed.said = flat(log);
	std::istringstream lines(fs::exists(list) ? read_file(list) : "");
	const std::vector<fs::path> folders = scene.folders();
	for (std::string line; std::getline(lines, line);) {
		for (size_t i = 0; i < folders.size(); ++i)
			if (const std::string front = (plain_name(folders[i], scratch.path(), i) / "").string(); line.rfind(front, 0) == 0)
				line.replace(0, front.size(), (folders[i] / "").string());
		if (line != scratch.path() / "dry.ini")
			parsed.reads.insert(line);
	}
	return parsed;
}

double start_time(const SettledScene& scene, int frame, const Trier& trier, double parse_seconds, double patience) {
	const ScratchFolder scratch(fs::temp_directory_path());
	return timed(scene_command(scene, one_pixel(scene.spec, frame), trier, scratch.path()), trier, parse_seconds, patience);
}

double frame_time(const SettledScene& scene, int frame, const Trier& trier, double parse_seconds, double patience) {
	const ScratchFolder scratch(fs::temp_directory_path());
	SettledScene small = scene;
	constexpr int smaller = 8;
	small.spec.width = std::max(1, scene.spec.width / smaller);
	small.spec.height = std::max(1, scene.spec.height / smaller);
	const double pixels = double(scene.spec.width) * scene.spec.height / (double(small.spec.width) * small.spec.height);
	return timed(scene_command(small, povray_ini(small.spec, frame), trier, scratch.path()), trier, parse_seconds, patience) *
		   pixels;
}

} // namespace farm
