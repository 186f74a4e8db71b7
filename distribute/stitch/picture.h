// SPDX-License-Identifier: AGPL-3.0-or-later
/// Pictures cut to strips and put together again, as PNG or OpenEXR. Pixels are copied, never converted.
///
/// A strip is a picture of its rows alone. Everything throws Error for a file that is damaged or not what it should be.
#ifndef FARM_PICTURE_H
#define FARM_PICTURE_H

#include "distribute/protocol/messages.h"

#include <filesystem>

namespace farm {

/// Rows [row, row + rows) of povray's whole-frame picture as a strip.
void cut(Format format, const std::filesystem::path& whole, int row, int rows, const std::filesystem::path& strip);

/// Decodes a strip to its last pixel and compares its size and depth with the job's. Returns the SHA-256 of its pixels, which
/// does not hang on how the file is packed.
std::string check_strip(const JobSpec& spec, int row, int rows, const std::filesystem::path& strip);

/// What all strips of a job must have in common to be joined, from the file's header alone: channels, bits, gamma.
std::string kind_of(Format format, const std::filesystem::path& strip);

/// Puts all strips of a frame, in order, into one picture.
void stitch(const JobSpec& spec, const std::vector<std::filesystem::path>& strips, const std::filesystem::path& picture);

namespace png {
void cut(const std::filesystem::path& whole, int row, int rows, const std::filesystem::path& strip);
std::string check_strip(const JobSpec& spec, int rows, const std::filesystem::path& strip);
std::string kind_of(const std::filesystem::path& strip);
void stitch(const JobSpec& spec, const std::vector<std::filesystem::path>& strips, const std::filesystem::path& picture);
} // namespace png

namespace exr {
void cut(const std::filesystem::path& whole, int row, int rows, const std::filesystem::path& strip);
std::string check_strip(const JobSpec& spec, int row, int rows, const std::filesystem::path& strip);
std::string kind_of(const std::filesystem::path& strip);
void stitch(const JobSpec& spec, const std::vector<std::filesystem::path>& strips, const std::filesystem::path& picture);
} // namespace exr

} // namespace farm
#endif
