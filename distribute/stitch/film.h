// SPDX-License-Identifier: AGPL-3.0-or-later
/// Frames to a film, by ffmpeg.
#ifndef FARM_FILM_H
#define FARM_FILM_H

#include <filesystem>
#include <vector>

namespace farm {

/// Encodes pictures in order, at `rate` a second, as H.264 in the file's container (.mp4, .mkv, ...). Every player takes it:
/// yuv420p, an even size (a black line makes up for an odd one). Works in a folder below `work`, on the film's own disk. Throws
/// Error with ffmpeg's last line, or one that says that the disk is full.
void make_film(const std::vector<std::filesystem::path>& pictures, double rate, const std::filesystem::path& film,
	const std::filesystem::path& work);

} // namespace farm
#endif
