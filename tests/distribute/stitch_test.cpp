// SPDX-License-Identifier: AGPL-3.0-or-later
// Strips that are joined without being packed anew: libpng, which knows nothing of that, reads the same pixels; and what only
// pretends to be such a strip is refused.
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/stitch/picture.h"
#include "distribute/stitch/png_join.h"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <fstream>
#include <random>

namespace {

using namespace farm;

class Join : public ::testing::Test {
protected:
	ScratchFolder scratch{fs::temp_directory_path()};
	std::minstd_rand chance{7};

	fs::path at(const std::string& name) const { return scratch.path() / name; }
	static void write(const fs::path& file, const std::string& data) { std::ofstream(file, std::ios::binary) << data; }

	/// libpng's whole picture of waves and noise, in one of povray's kinds; its rows.
	std::vector<std::string> whole(int width, int height, int depth, int colours, const fs::path& to) {
		png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
		png_infop info = png_create_info_struct(png);
		std::FILE* file = std::fopen(to.c_str(), "wb");
		png_init_io(png, file);
		png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth, colours, 0, 0, 0);
		png_set_gAMA_fixed(png, info, 45455);
		png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
		png_write_info(png, info);
		std::vector<std::string> rows;
		for (int y = 0; y < height; ++y) {
			std::string row(png_get_rowbytes(png, info), 0);
			for (size_t i = 0; i < row.size(); ++i)
				row[i] = static_cast<char>(static_cast<int>(i) / 3 + y * 2 + (y % 5 ? static_cast<int>(chance() >> 9) % 4 : 0));
			png_write_row(png, reinterpret_cast<png_bytep>(row.data()));
			rows.push_back(row);
		}
		png_write_end(png, info);
		png_destroy_write_struct(&png, &info);
		std::fclose(file);
		return rows;
	}

	static std::vector<std::string> rows_of(const fs::path& from, std::string* gamma = nullptr) {
		png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
		png_infop info = png_create_info_struct(png);
		std::FILE* file = std::fopen(from.c_str(), "rb");
		png_init_io(png, file);
		png_read_info(png, info);
		png_fixed_point g = 0;
		int intent = -1;
		png_get_gAMA_fixed(png, info, &g);
		png_get_sRGB(png, info, &intent);
		if (gamma)
			*gamma = std::to_string(g) + " " + std::to_string(intent);
		std::vector<std::string> rows(png_get_image_height(png, info), std::string(png_get_rowbytes(png, info), 0));
		for (auto& row : rows)
			png_read_row(png, reinterpret_cast<png_bytep>(row.data()), nullptr);
		png_read_end(png, nullptr);
		png_destroy_read_struct(&png, &info, nullptr);
		std::fclose(file);
		return rows;
	}

	static JobSpec spec_for(int width, int height, int depth) {
		JobSpec spec;
		spec.width = width;
		spec.height = height;
		spec.bits = depth;
		return spec;
	}
};

std::string with_crc(std::string named) {
	const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
	for (int shift = 24; shift >= 0; shift -= 8)
		named += static_cast<char>(sum >> shift & 255);
	return named;
}

TEST_F(Join, GivesThePixelsOfTheWhole) {
	for (const int colours : {0, 2, 4, 6})
		for (const int depth : {8, 16}) {
			const int width = 37, height = 41;
			const auto rows = whole(width, height, depth, colours, at("whole.png"));
			const JobSpec spec = spec_for(width, height, depth);
			std::vector<fs::path> strips;
			for (int row = 0, some = 1; row < height; row += some, some = std::min(height - row, some + 6)) {
				strips.push_back(at(std::to_string(row) + ".png"));
				cut(Format::png, at("whole.png"), row, some, strips.back());
				EXPECT_TRUE(png::is_joinable(strips.back()));
				EXPECT_EQ(rows_of(strips.back()), std::vector<std::string>(rows.begin() + row, rows.begin() + row + some));
				// Its hash is that of the same pixels as any other PNG.
				EXPECT_EQ(check_strip(spec, row, some, strips.back()).size(), 64u);
				if (row + some == height)
					break;
			}
			fs::remove(at("joined.png"));
			stitch(spec, strips, at("joined.png"));
			std::string gamma;
			EXPECT_EQ(rows_of(at("joined.png"), &gamma), rows);
			EXPECT_EQ(gamma, "45455 0");
			cut(Format::png, at("whole.png"), 0, height, at("all.png"));
			EXPECT_EQ(check_strip(spec, 0, height, at("all.png")), check_strip(spec, 0, height, at("whole.png")));
			EXPECT_FALSE(png::is_joinable(at("whole.png")));
			// Among others that cannot be joined it still gives the same picture.
			fs::remove(at("joined.png"));
			JobSpec twice = spec;
			twice.height *= 2;
			stitch(twice, {at("whole.png"), at("all.png")}, at("joined.png"));
			auto both = rows;
			both.insert(both.end(), rows.begin(), rows.end());
			EXPECT_EQ(rows_of(at("joined.png")), both);
		}
}

TEST_F(Join, WhatIsDamagedIsRefused) {
	whole(20, 12, 8, 2, at("whole.png"));
	cut(Format::png, at("whole.png"), 0, 12, at("strip.png"));
	const JobSpec spec = spec_for(20, 12, 8);
	const std::string good = read_file(at("strip.png")), pixels = check_strip(spec, 0, 12, at("strip.png"));
	for (size_t i = 0; i < good.size(); ++i) {
		std::string bad = good;
		bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
		write(at("bad.png"), bad);
		EXPECT_THROW(check_strip(spec, 0, 12, at("bad.png")), Error) << "byte " << i;
		write(at("bad.png"), good.substr(0, i));
		EXPECT_THROW(check_strip(spec, 0, 12, at("bad.png")), Error) << "cut at " << i;
	}
	EXPECT_EQ(check_strip(spec, 0, 12, at("strip.png")), pixels);
}

// Good PNGs, each of them, that would spoil the frame they are joined to.
TEST_F(Join, WhatOnlyPretendsIsRefused) {
	const int width = 5, height = 3;
	const JobSpec spec = spec_for(width, height, 8);
	std::string filtered;
	for (int y = 0; y < height; ++y)
		filtered += '\0' + std::string(3 * width, static_cast<char>(40 * y));
	whole(width, height, 8, 2, at("whole.png"));
	cut(Format::png, at("whole.png"), 0, height, at("strip.png"));
	const std::string model = read_file(at("strip.png")), head = model.substr(0, model.find("IDAT") - 4);
	const auto make = [&](const std::string& packed) {
		std::string length;
		for (int shift = 24; shift >= 0; shift -= 8)
			length += static_cast<char>(packed.size() >> shift & 255);
		const std::string end(4, '\0');
		write(at("made.png"), head + length + with_crc("IDAT" + packed) + end + with_crc("IEND"));
		EXPECT_NO_THROW(rows_of(at("made.png"))) << "the test's own PNG is bad";
		return at("made.png");
	};
	const auto pack = [](const std::string& data, bool flush, int strategy) {
		z_stream z{};
		deflateInit2(&z, 9, Z_DEFLATED, 15, 8, strategy);
		std::string out(1000, 0);
		z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
		z.avail_in = static_cast<uInt>(data.size());
		z.next_out = reinterpret_cast<Bytef*>(out.data());
		z.avail_out = static_cast<uInt>(out.size());
		if (flush)
			deflate(&z, Z_FULL_FLUSH);
		deflate(&z, Z_FINISH);
		out.resize(z.total_out);
		deflateEnd(&z);
		return out;
	};
	const auto sum = [](const std::string& data) {
		const uLong s = adler32(1, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
		std::string out;
		for (int shift = 24; shift >= 0; shift -= 8)
			out += static_cast<char>(s >> shift & 255);
		return out;
	};
	EXPECT_NO_THROW(check_strip(spec, 0, height, make(pack(filtered, true, Z_DEFAULT_STRATEGY))));
	EXPECT_THROW(check_strip(spec, 0, height, make(pack(filtered, false, Z_DEFAULT_STRATEGY))), Error) << "no boundary";
	// One stored block, the last, whose end looks like a boundary and an empty block.
	std::string looks = filtered;
	looks.replace(looks.size() - 6, 6, std::string("\x00\x00\xff\xff\x03\x00", 6));
	const auto n = static_cast<char>(looks.size());
	std::string stored = std::string("\x78\x9c\x01", 3) + n + '\0' + static_cast<char>(~n) + '\xff' + looks + sum(looks);
	EXPECT_THROW(check_strip(spec, 0, height, make(stored)), Error) << "the end of a stored block";
	// A first row that hangs on the one above, which there it is not zeros.
	std::string up = filtered;
	up[0] = 2;
	EXPECT_THROW(check_strip(spec, 0, height, make(pack(up, true, Z_DEFAULT_STRATEGY))), Error) << "the row above";
	up[0] = 5;
	std::string more = filtered + std::string(3 * width + 1, '\0');
	EXPECT_THROW(check_strip(spec, 0, height, make(pack(more, true, Z_DEFAULT_STRATEGY))), Error) << "a row too many";
}

} // namespace
