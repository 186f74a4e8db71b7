// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/stitch/preview.h"

#include "distribute/stitch/libpng.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <cmath>

namespace farm {

using Path = std::filesystem::path;

/// Takes a picture's rows one after the other and sums up those that fall to the same row of the preview.
class PreviewRows {
public:
	PreviewRows(Preview& p, int first) : preview(p), row(first), sums(static_cast<size_t>(4 * p.width)) {}
	~PreviewRows() { flush(); }

	/// One row: 4 values a pixel, linear, alpha multiplied in, 65535 is white.
	void add(const float* values) {
		const int target = static_cast<int>(std::int64_t{row++} * preview.height / preview.frame_height);
		if (target != current) {
			flush();
			current = target;
		}
		++rows;
		for (int x = 0; x < preview.width; ++x) {
			const auto from = std::int64_t{x} * preview.frame_width / preview.width;
			const auto to = std::int64_t{x + 1} * preview.frame_width / preview.width;
			double part[4] = {};
			for (auto i = from; i < to; ++i)
				for (int c = 0; c < 4; ++c)
					part[c] += values[4 * i + c];
			for (int c = 0; c < 4; ++c)
				sums[static_cast<size_t>(4 * x + c)] += part[c] / static_cast<double>(to - from);
		}
	}

private:
	// Two strips may meet within a row of the preview: it is the mean of what has come of it.
	void flush() {
		if (rows > 0) {
			int& before = preview.rows_in[static_cast<size_t>(current)];
			std::uint16_t* const line = preview.pixels.data() + sums.size() * static_cast<size_t>(current);
			for (size_t i = 0; i < sums.size(); ++i)
				line[i] = static_cast<std::uint16_t>(std::lround((line[i] * before + sums[i]) / (before + rows)));
			before += rows;
		}
		std::fill(sums.begin(), sums.end(), 0.0);
		rows = 0;
	}

	Preview& preview;
	int row, current = -1, rows = 0;
	std::vector<double> sums;
};

namespace {

Error other_size(const Path& picture) { return Error(picture.string() + " has another size than it should"); }

/// The light of each 16-bit value, from 0 to 1: of a PNG's gAMA (100,000 times the exponent), or sRGB if that is 0. libpng's own
/// tables take sRGB for a power law, and make dark skies black.
std::vector<float> linear(png_fixed_point gamma) {
	std::vector<float> table(65536);
	for (size_t i = 0; i < table.size(); ++i) {
		const double v = static_cast<double>(i) / 65535;
		const double light = gamma > 0      ? std::pow(v, 100000.0 / gamma)
							 : v <= 0.04045 ? v / 12.92
											: std::pow((v + 0.055) / 1.055, 2.4);
		table[i] = static_cast<float>(light);
	}
	return table;
}

void add_png(PreviewRows& to, const Path& picture, int width, int rows) {
	const std::string name = picture.string();
	const png::File file(std::fopen(name.c_str(), "rb"));
	if (!file)
		throw system_error("cannot read " + name);
	struct Reading {
		explicit Reading(const std::string& file_name)
			: png(png_create_read_struct(PNG_LIBPNG_VER_STRING, const_cast<std::string*>(&file_name), png::fail, png::hush)),
			  info(png_create_info_struct(png)) {}
		~Reading() { png_destroy_read_struct(&png, &info, nullptr); }
		png_structp png;
		png_infop info;
	} r(name);
	png_init_io(r.png, file.get());
	png_read_info(r.png, r.info);
	if (png_get_image_width(r.png, r.info) != static_cast<png_uint_32>(width) ||
		png_get_image_height(r.png, r.info) != static_cast<png_uint_32>(rows) ||
		png_get_interlace_type(r.png, r.info) != PNG_INTERLACE_NONE)
		throw other_size(picture);
	png_fixed_point gamma = 0;
	if (png_get_valid(r.png, r.info, PNG_INFO_sRGB) || !png_get_gAMA_fixed(r.png, r.info, &gamma))
		gamma = 0;
	static const std::vector<float> srgb = linear(0);
	const std::vector<float> other = gamma > 0 ? linear(gamma) : std::vector<float>();
	const std::vector<float>& light = gamma > 0 ? other : srgb;
	// Always 16 bits, in the machine's order, with alpha.
	png_set_expand_16(r.png);
	png_set_gray_to_rgb(r.png);
	png_set_add_alpha(r.png, 0xffff, PNG_FILLER_AFTER);
	png_set_swap(r.png);
	png_read_update_info(r.png, r.info);
	if (png_get_rowbytes(r.png, r.info) != 8 * static_cast<size_t>(width))
		throw Error(name + ": a PNG of this kind is none of povray's");
	std::vector<std::uint16_t> row(4 * static_cast<size_t>(width));
	std::vector<float> values(row.size());
	for (int i = 0; i < rows; ++i) {
		png_read_row(r.png, reinterpret_cast<png_bytep>(row.data()), nullptr);
		for (size_t v = 0; v < row.size(); ++v)
			values[v] = v % 4 == 3 ? row[v] : light[row[v]] * row[v | 3];
		to.add(values.data());
	}
}

void add_exr(PreviewRows& to, const Path& picture, int width, int rows) {
	constexpr int at_once = 16;
	try {
		Imf::InputFile in(picture.c_str(), 0);
		const auto window = in.header().dataWindow();
		if (window.max.x - window.min.x + 1 != width || window.max.y - window.min.y + 1 != rows)
			throw other_size(picture);
		const size_t pitch = 4 * static_cast<size_t>(width);
		std::vector<float> block(pitch * at_once);
		for (int done = 0; done < rows; done += at_once) {
			const int first = window.min.y + done, last = std::min(first + at_once - 1, window.max.y);
			Imf::FrameBuffer buffer;
			const char* const names[] = {"R", "G", "B", "A"};
			for (int c = 0; c < 4; ++c) {
				// OpenEXR counts from pixel (0, 0) of the frame.
				char* const base =
					reinterpret_cast<char*>(block.data() + c) -
					static_cast<std::ptrdiff_t>(sizeof(float)) *
						(static_cast<std::ptrdiff_t>(pitch) * first + 4 * static_cast<std::ptrdiff_t>(window.min.x));
				buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base, 4 * sizeof(float), pitch * sizeof(float), 1, 1, c == 3));
			}
			in.setFrameBuffer(buffer);
			in.readPixels(first, last);
			for (float& v : block)
				v = 65535 * (v > 0 ? std::min(v, 1.0F) : 0); // not a number is black
			for (int i = first; i <= last; ++i)
				to.add(block.data() + pitch * static_cast<size_t>(i - first));
		}
	} catch (const Error&) {
		throw;
	} catch (const std::exception& e) {
		throw Error(picture.string() + ": " + e.what());
	}
}

} // namespace

Preview::Preview(int w, int h, int size) : frame_width(w), frame_height(h) {
	const double shrink = std::min(1.0, size / static_cast<double>(std::max(w, h)));
	width = std::max(1, static_cast<int>(std::lround(w * shrink)));
	height = std::max(1, static_cast<int>(std::lround(h * shrink)));
	pixels.resize(4 * static_cast<size_t>(width) * static_cast<size_t>(height));
	rows_in.resize(static_cast<size_t>(height));
}

void Preview::add(Format format, const Path& picture, int row, int rows) {
	PreviewRows to(*this, row);
	format == Format::png ? add_png(to, picture, frame_width, rows) : add_exr(to, picture, frame_width, rows);
}

std::string Preview::png() const {
	png_image image{};
	image.version = PNG_IMAGE_VERSION;
	image.width = static_cast<png_uint_32>(width);
	image.height = static_cast<png_uint_32>(height);
	image.format = PNG_FORMAT_LINEAR_RGB_ALPHA;
	image.flags = PNG_IMAGE_FLAG_FAST;
	png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
	std::string packed(size, '\0');
	if (!png_image_write_to_memory(&image, packed.data(), &size, 1, pixels.data(), 0, nullptr))
		throw Error(std::string("cannot pack a preview: ") + image.message);
	packed.resize(size);
	return packed;
}

} // namespace farm
