// SPDX-License-Identifier: AGPL-3.0-or-later
/// Strips as PNG that a server joins without packing them anew, which would cost it more than all else.
///
/// Such a strip is a PNG like others (ISO/IEC 15948) with a chunk `bhJn` of its own. Its first row is filtered without the row
/// above, and its packed data (RFC 1951) ends at a byte's boundary, after which comes an empty last block. So packed data without
/// those two bytes and what frames it (RFC 1950) may be put one after the other.
#ifndef FARM_PNG_JOIN_H
#define FARM_PNG_JOIN_H

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace farm::png {

/// What a picture is made of, apart from its height.
struct Kind {
	std::uint32_t width = 0;
	int depth = 0, colours = 0; ///< bits of a sample; PNG's colour type
	bool has_gamma = false, has_srgb = false;
	std::int32_t gamma = 0; ///< in 1/100000
	int intent = 0;         ///< sRGB's

	bool operator==(const Kind& o) const {
		return width == o.width && depth == o.depth && colours == o.colours && has_gamma == o.has_gamma &&
			   has_srgb == o.has_srgb && gamma == o.gamma && intent == o.intent;
	}
	/// Bytes of a pixel. Throws Error for kinds that are none of povray's.
	size_t step() const;
	size_t row_bytes() const { return width * step(); }
};

/// `pixels` are whole rows, one after the other.
void write_joinable(const std::filesystem::path& strip, const Kind& kind, const std::string& pixels);
/// Whether the strip says that it is such a one. Throws Error for a file that cannot be read.
bool is_joinable(const std::filesystem::path& strip);
/// Reads one that says so: `begin` gets what it is and how many rows it has, `each` the pixels of whole rows, some at a time.
/// Throws Error unless it is true to the last bit, which may be found after all rows were given out.
void read_joinable(const std::filesystem::path& strip, const std::function<void(const Kind&, std::uint32_t)>& begin,
	const std::function<void(std::string_view)>& each);
/// Joins strips that `read_joinable` was content with; throws Error if they have not `height` rows or are of unlike kinds.
void join(const std::vector<std::filesystem::path>& strips, int height, const std::filesystem::path& picture);

} // namespace farm::png
#endif
