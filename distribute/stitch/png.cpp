// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/hash.h"
#include "distribute/stitch/libpng.h"
#include "distribute/stitch/picture.h"
#include "distribute/stitch/png_join.h"

#include <algorithm>
#include <utility>

namespace farm::png {
namespace {

using Path = std::filesystem::path;
using Row = std::vector<png_byte>;

class Reader {
public:
	explicit Reader(const Path& path) : name(path.string()), file(std::fopen(path.c_str(), "rb")) {
		if (!file)
			throw system_error("cannot read " + name);
		png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &name, fail, hush);
		info = png_create_info_struct(png);
		try {
			png_init_io(png, file.get());
			png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
			png_read_info(png, info);
			int interlace = 0;
			png_get_IHDR(png, info, &kind.width, &height, &kind.depth, &kind.colours, &interlace, nullptr, nullptr);
			if (interlace != PNG_INTERLACE_NONE || kind.colours == PNG_COLOR_TYPE_PALETTE)
				throw Error(name + ": a PNG of this kind is none of povray's");
			kind.has_gamma = png_get_gAMA_fixed(png, info, &kind.gamma) != 0;
			kind.has_srgb = png_get_sRGB(png, info, &kind.intent) != 0;
		} catch (...) {
			png_destroy_read_struct(&png, &info, nullptr);
			throw;
		}
	}
	~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
	Reader(const Reader&) = delete;

	void next(Row& row) {
		row.resize(png_get_rowbytes(png, info));
		png_read_row(png, row.data(), nullptr);
	}
	/// What follows the last row must be whole too.
	void end() { png_read_end(png, nullptr); }

	Kind kind;
	png_uint_32 height = 0;

private:
	std::string name;
	File file;
	png_structp png;
	png_infop info;
};

class Writer {
public:
	Writer(const Path& path, const Kind& kind, int height) : name(path.string()), file(std::fopen(path.c_str(), "wb")) {
		if (!file)
			throw system_error("cannot write " + name);
		png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &name, fail, hush);
		info = png_create_info_struct(png);
		try {
			png_init_io(png, file.get());
			png_set_IHDR(png, info, kind.width, static_cast<png_uint_32>(height), kind.depth, kind.colours, PNG_INTERLACE_NONE,
				PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
			if (kind.has_srgb)
				png_set_sRGB(png, info, kind.intent);
			if (kind.has_gamma)
				png_set_gAMA_fixed(png, info, kind.gamma);
			png_write_info(png, info);
		} catch (...) {
			png_destroy_write_struct(&png, &info);
			throw;
		}
	}
	~Writer() { png_destroy_write_struct(&png, &info); }
	Writer(const Writer&) = delete;

	void next(Row& row) { png_write_row(png, row.data()); }
	void end() {
		png_write_end(png, info);
		if (std::fclose(file.release()) != 0)
			throw system_error("cannot write " + name);
	}

private:
	std::string name;
	File file;
	png_structp png;
	png_infop info;
};

/// Pixels are named with what they mean.
Sha256 name_of(const Kind& kind) {
	Sha256 name;
	name.add("png " + std::to_string(kind.colours) + " " + std::to_string(kind.depth) + " " + std::to_string(kind.gamma) + "\n");
	return name;
}

} // namespace

void cut(const Path& whole, int row, int rows, const Path& strip) {
	Reader in(whole);
	if (in.height < static_cast<png_uint_32>(row + rows))
		throw Error(
			whole.string() + " has " + std::to_string(in.height) + " rows; " + std::to_string(row + rows) + " are needed");
	Row pixels;
	std::string all;
	for (int i = 0; i < row + rows; ++i) {
		in.next(pixels);
		if (i >= row)
			all.append(reinterpret_cast<const char*>(pixels.data()), pixels.size());
	}
	write_joinable(strip, in.kind, all);
}

std::string check_strip(const JobSpec& spec, int rows, const Path& strip) {
	const auto fits = [&](const Kind& kind, std::size_t height) {
		if (kind.width != static_cast<png_uint_32>(spec.width) || height != static_cast<std::size_t>(rows) ||
			kind.depth != spec.bits)
			throw Error("the strip is " + std::to_string(kind.width) + "x" + std::to_string(height) + " of " +
						std::to_string(kind.depth) + " bits; " + std::to_string(spec.width) + "x" + std::to_string(rows) +
						" of " + std::to_string(spec.bits) + " are needed");
	};
	Reader in(strip); // its header
	fits(in.kind, in.height);
	if (is_joinable(strip)) {
		Sha256 name;
		const auto begin = [&](const Kind& kind, std::size_t height) {
			fits(kind, height);
			name = name_of(kind);
		};
		read_joinable(strip, begin, [&](std::string_view some) { name.add(some); });
		return name.name();
	}
	Row pixels; // one at a time: a whole frame may have gigabytes
	Sha256 name = name_of(in.kind);
	for (int i = 0; i < rows; ++i) {
		in.next(pixels);
		name.add({reinterpret_cast<const char*>(pixels.data()), pixels.size()});
	}
	in.end();
	return name.name();
}

std::string kind_of(const Path& strip) {
	const Kind kind = Reader(strip).kind;
	return "PNG's colour type " + std::to_string(kind.colours) + ", " + std::to_string(kind.depth) + " bits, gamma " +
		   (kind.has_gamma ? std::to_string(kind.gamma) : "none") +
		   (kind.has_srgb ? ", sRGB " + std::to_string(kind.intent) : "");
}

void stitch(const JobSpec& spec, const std::vector<Path>& strips, const Path& picture) {
	if (std::all_of(strips.begin(), strips.end(), is_joinable))
		return join(strips, spec.height, picture);
	const Kind kind = Reader(strips.at(0)).kind;
	Writer out(picture, kind, spec.height);
	int done = 0;
	Row pixels;
	for (const auto& strip : strips) {
		Reader in(strip);
		if (!(in.kind == kind))
			throw Error(strip.string() + " is of another kind than " + strips[0].string());
		for (png_uint_32 i = 0; i < in.height && done < spec.height; ++i, ++done) {
			in.next(pixels);
			out.next(pixels);
		}
	}
	if (done != spec.height)
		throw Error(picture.string() + ": its strips have " + std::to_string(done) + " rows");
	out.end();
}

} // namespace farm::png
