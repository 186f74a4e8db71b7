// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/stitch/film.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/process.h"

#include <cerrno>
#include <cstring>
#include <iomanip>
#include <sstream>

namespace farm {
namespace {

/// Bytes; with fewer left, it is for want of room that ffmpeg failed.
constexpr std::uintmax_t least_room = 1 << 20;

} // namespace

void make_film(const std::vector<fs::path>& pictures, double rate, const fs::path& film, const fs::path& work) {
	const ScratchFolder scratch(work);
	// Links in a folder of their own count through, whatever the pictures' names are.
	const std::string suffix = pictures.at(0).extension().string();
	for (size_t i = 0; i < pictures.size(); ++i) {
		std::ostringstream name;
		name << std::setfill('0') << std::setw(8) << i << suffix;
		fs::create_symlink(fs::absolute(pictures[i]), scratch.path() / name.str());
	}
	const fs::path log = scratch.path() / "log", made = scratch.path() / ("film" + film.extension().string());
	std::ostringstream speed;
	speed << rate;
	Command command;
	command.words = {"ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-framerate", speed.str(), "-i",
		(scratch.path() / ("%08d" + suffix)).string(), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p", "-c:v", "libx264",
		"-crf", "18", "-movflags", "+faststart", made.string()};
	if (suffix == ".exr") // linear light to what screens expect
		command.words.insert(command.words.begin() + 5, {"-apply_trc", "iec61966_2_1"});
	command.log = log;
	const int code = run(command);
	if (code != 0) {
		// On a full disk there is none for ffmpeg's complaint either.
		std::error_code unknown;
		const auto room = fs::space(scratch.path(), unknown).available;
		const std::string said = fs::exists(log) ? read_file(log) : "";
		if (said.find(std::strerror(ENOSPC)) != std::string::npos || (!unknown && room < least_room))
			throw Error("cannot write " + film.string() + ": " + std::strerror(ENOSPC), ENOSPC);
		std::istringstream lines(said);
		std::string last;
		for (std::string line; std::getline(lines, line);)
			last = line.empty() ? last : line;
		throw Error(code == 127 ? "there is no ffmpeg for the film" : "ffmpeg made no film: " + last);
	}
	move_durably(made, film);
}

} // namespace farm
