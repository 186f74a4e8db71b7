// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/stitch/picture.h"

namespace farm {

void cut(Format format, const std::filesystem::path& whole, int row, int rows, const std::filesystem::path& strip) {
	format == Format::png ? png::cut(whole, row, rows, strip) : exr::cut(whole, row, rows, strip);
}

std::string check_strip(const JobSpec& spec, int row, int rows, const std::filesystem::path& strip) {
	return spec.format == Format::png ? png::check_strip(spec, rows, strip) : exr::check_strip(spec, row, rows, strip);
}

std::string kind_of(Format format, const std::filesystem::path& strip) {
	return format == Format::png ? png::kind_of(strip) : exr::kind_of(strip);
}

void stitch(const JobSpec& spec, const std::vector<std::filesystem::path>& strips, const std::filesystem::path& picture) {
	if (strips.size() == 1) // a frame already
		return std::filesystem::create_hard_link(strips[0], picture);
	spec.format == Format::png ? png::stitch(spec, strips, picture) : exr::stitch(spec, strips, picture);
}

} // namespace farm
