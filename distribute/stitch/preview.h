// SPDX-License-Identifier: AGPL-3.0-or-later
/// A small picture of a frame that fills in with its strips.
#ifndef FARM_PREVIEW_H
#define FARM_PREVIEW_H

#include "distribute/protocol/messages.h"

#include <filesystem>

namespace farm {

/// Each pixel is the mean, in linear light, of those it stands for; what has not come is transparent. Not thread-safe.
class Preview {
public:
	/// Its longer side has `size` pixels, or as many as the frame's if that is smaller.
	Preview(int frame_width, int frame_height, int size);

	/// Puts in rows [row, row + rows) of the frame, each once, from a picture of these rows alone. Throws Error for a file that
	/// is damaged or of another size. No more than a few rows are in memory at once.
	void add(Format format, const std::filesystem::path& picture, int row, int rows);
	/// As a PNG of 8 bits, sRGB.
	std::string png() const;
	/// Of the pixels, in memory.
	size_t bytes() const { return pixels.size() * sizeof(pixels[0]); }

private:
	friend class PreviewRows;
	int frame_width, frame_height, width = 0, height = 0;
	std::vector<std::uint16_t> pixels; ///< linear, alpha multiplied in, 4 a pixel
	std::vector<int> rows_in;          ///< how many of the frame's rows each of ours has so far
};

} // namespace farm
#endif
