// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/render/povray.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/scene/ini.h"

#include <cstdlib>
#include <sstream>

namespace farm {
namespace {

/// What makes a strip's pixels those of the whole frame, whatever the cuts; and a slot a core.
const char* const same_pixels = "Reproducible=On\nWork_Threads=1\n";

/// The lines as they were before POV-Ray broke them at 80 columns: one that goes on starts with a blank, or follows a full one.
std::vector<std::string> unbroken(const std::string& log) {
	constexpr size_t columns = 80, most = 4000; // what is longer is no message
	std::istringstream lines(log);
	std::vector<std::string> whole;
	size_t last = 0;
	for (std::string line; std::getline(lines, line);) {
		const bool goes_on = !whole.empty() && (last == columns || (!line.empty() && line[0] == ' '));
		last = line.size();
		if (goes_on && whole.back().size() < most)
			whole.back() += line;
		else if (!goes_on)
			whole.push_back(line);
	}
	return whole;
}

} // namespace

std::string povray_ini(const JobSpec& spec, int frame) {
	std::string ini;
	for (const auto& line : spec.options)
		ini += line + "\n";
	ini += "Width=" + std::to_string(spec.width) + "\nHeight=" + std::to_string(spec.height) + "\n";
	// Initial_Frame and Final_Frame stay as they are, for the clock: with both the same it would be no number.
	if (spec.animation)
		ini += "Subset_Start_Frame=" + std::to_string(frame) + "\nSubset_End_Frame=" + std::to_string(frame) + "\n";
	// -GA would silence errors too.
	return ini + "Display=Off\nVerbose=Off\nPause_When_Done=Off\nContinue_Trace=Off\n" + same_pixels;
}

std::string strip_ini(const Task& task, const std::filesystem::path& picture) {
	const JobSpec& spec = task.spec;
	std::string ini = povray_ini(spec, task.frame);
	// Rows count from 1, and 1 itself would mean 100 %: 1.5 is the first.
	if (task.row > 0)
		ini += "Start_Row=" + std::to_string(task.row + 1) + "\n";
	if (const int end = task.row + task.rows; end < spec.height)
		ini += "End_Row=" + (end == 1 ? "1.5" : std::to_string(end)) + "\n";
	ini += std::string("Output_To_File=On\nOutput_File_Type=") + (spec.format == Format::png ? "N" : "E") + "\n";
	ini += "Bits_Per_Color=" + std::to_string(spec.bits) + "\nOutput_File_Name=\"" + picture.string() + "\"\n";
	return ini;
}

std::string scene_in(const std::filesystem::path& folder) { return ini_line({"Library_Path", folder.string()}) + "\n"; }

Command povray_command(const std::filesystem::path& povray, const std::filesystem::path& ini, const std::filesystem::path& home) {
	Command command;
	command.words = {povray.string()};
	command.environment = {{"POVINI", ini.string()}, {"HOME", home.string()}, {"POVINC", home.string()},
		{"POV_TEMP_DIR", home.string()}, {"DISPLAY", ""}, {"LC_ALL", "C"}};
	return command;
}

std::string error_line(const std::string& log, int code, const std::filesystem::path& folder) {
	std::string found, fatal, announced;
	for (const std::string& line : unbroken(log)) {
		// "Possible Parse Error" only announces the real one; but that may not say which file it is that cannot be opened.
		const bool announces = line.find("Possible Parse Error:") != std::string::npos;
		const bool error = line.find("rror:") != std::string::npos && !announces;
		if (announced.empty() && announces)
			announced = line.substr(0, 2000);
		if (found.empty() && error)
			found = line.substr(0, 2000);
		else if (line.rfind("Fatal error", 0) == 0 || line.rfind("Failed to ", 0) == 0)
			fatal = line.substr(0, 2000);
	}
	if (found.empty())
		found = fatal;
	if (!announced.empty() && (found.empty() || found == fatal || found == "Parse Error: Cannot open input file."))
		found = announced;
	// The scene's own name for a file, not ours.
	const std::string front = (folder / "").string();
	for (size_t at = 0; !folder.empty() && (at = found.find(front, at)) != std::string::npos;)
		found.erase(at, front.size());
	std::string tidy;
	for (const char c : found)
		if (c != ' ' || (!tidy.empty() && tidy.back() != ' '))
			tidy += static_cast<unsigned char>(c) < 32 ? ' ' : c;
	if (!tidy.empty())
		return tidy;
	if (code == 127)
		return "povray could not be run";
	if (code > 128)
		return "povray was ended by signal " + std::to_string(code - 128) + (code == 137 ? " (out of memory, perhaps)" : "");
	return code == 0 ? "povray ended well but wrote no picture"
					 : "povray ended with exit code " + std::to_string(code) + " and no message";
}

bool did_not_start(const std::string& log) {
	return log.find("Timed out waiting for worker thread startup") != std::string::npos;
}

std::pair<int, std::string> run_povray(const Command& command, const std::atomic<bool>* stop) {
	for (int tries = 0;; ++tries) {
		std::error_code ignored;
		fs::remove(command.log, ignored);
		const int code = run(command, stop);
		const std::string log = fs::exists(command.log) ? read_file(command.log) : "";
		if (code == 0 || !did_not_start(log) || tries == 5)
			return {code, log};
	}
}

std::filesystem::path find_povray(const std::string& given) {
	const char* variable = std::getenv("BHFARM_POVRAY");
	const fs::path place = !given.empty()          ? fs::path(given)
						   : variable && *variable ? fs::path(variable)
												   : program_folder() / "povray";
	if (!fs::is_regular_file(place))
		throw Error("there is no povray at " + place.string() + "; --povray says where it is");
	return fs::absolute(place);
}

std::string povray_version(const std::filesystem::path& povray, const Sandbox& sandbox) {
	const ScratchFolder scratch(fs::temp_directory_path());
	Command command = povray_command(povray, scratch.path() / "none", scratch.path());
	command.words.push_back("--version");
	command.log = scratch.path() / "log";
	const int code = run(sandbox.fenced(command, {{scratch.path()}, {}, false}));
	std::istringstream lines(fs::exists(command.log) ? read_file(command.log) : "");
	for (std::string line; std::getline(lines, line);)
		if (line.rfind("POV-Ray ", 0) == 0)
			return line;
	throw Error(povray.string() + " --version ended with " + std::to_string(code) + " and named no version");
}

} // namespace farm
