// SPDX-License-Identifier: AGPL-3.0-or-later
// EXR cut and joined, against what OpenEXR by itself wrote and reads.
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/stitch/picture.h"
#include "tests/distribute/exr_file.h"

#include <gtest/gtest.h>

#include <ImfInputFile.h>
#include <random>

namespace {

using namespace farm;

class Exr : public ::testing::Test {
protected:
	static constexpr int width = 23, height = 150; ///< several of OpenEXR's blocks
	ScratchFolder scratch{fs::temp_directory_path()};

	fs::path at(const std::string& name) const { return scratch.path() / name; }
	static JobSpec spec() {
		JobSpec s;
		s.format = Format::exr;
		s.width = width;
		s.height = height;
		s.bits = 16;
		return s;
	}
	/// Noise: all rows, channel after channel in each.
	std::vector<std::vector<half>> write(const fs::path& to, const std::vector<std::string>& names, bool down) const {
		std::minstd_rand chance(5);
		std::vector<std::vector<half>> rows(height, std::vector<half>(width * names.size()));
		for (auto& row : rows)
			for (half& value : row)
				value.setBits(static_cast<unsigned short>(chance() >> 8 & 0x3fff)); // no infinities
		ExrFile file(to, width, height, names, down);
		for (int y = 0; y < height; ++y)
			file.add_row(rows[static_cast<size_t>(down ? y : height - 1 - y)]);
		return rows;
	}
	static std::vector<std::vector<half>> rows_of(const fs::path& from, const std::vector<std::string>& names) {
		Imf::InputFile file(from.c_str(), 0);
		const auto window = file.header().dataWindow();
		std::vector<std::vector<half>> rows;
		for (int y = window.min.y; y <= window.max.y; ++y) {
			std::vector<half> row(width * names.size());
			Imf::FrameBuffer buffer;
			for (size_t c = 0; c < names.size(); ++c)
				buffer.insert(names[c], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(row.data() + c * width), sizeof(half), 0));
			file.setFrameBuffer(buffer);
			file.readPixels(y);
			rows.push_back(row);
		}
		return rows;
	}
};

TEST_F(Exr, StripsGiveThePixelsOfTheWhole) {
	for (const auto& names : std::vector<std::vector<std::string>>{{"Y"}, {"B", "G", "R"}, {"A", "B", "G", "R"}})
		for (const bool down : {true, false}) {
			const auto rows = write(at("whole.exr"), names, down);
			std::vector<fs::path> strips;
			for (int row = 0, some = 1; row < height; row += some, some = std::min(height - row, 3 * some + 5)) {
				strips.push_back(at(std::to_string(row) + ".exr"));
				cut(Format::exr, at("whole.exr"), row, some, strips.back());
				EXPECT_EQ(rows_of(strips.back(), names),
					(std::vector<std::vector<half>>(rows.begin() + row, rows.begin() + row + some)));
				EXPECT_EQ(check_strip(spec(), row, some, strips.back()).size(), 64u);
				if (row + some == height)
					break;
			}
			EXPECT_GE(strips.size(), 4u);
			fs::remove(at("joined.exr"));
			stitch(spec(), strips, at("joined.exr"));
			EXPECT_EQ(rows_of(at("joined.exr"), names), rows);
			// The hash is that of the pixels, however they are packed.
			EXPECT_EQ(check_strip(spec(), 0, height, at("joined.exr")), check_strip(spec(), 0, height, at("whole.exr")));
		}
}

TEST_F(Exr, OnePixelMakesAnotherHash) {
	const auto rows = write(at("whole.exr"), {"B", "G", "R"}, true);
	for (const int changed : {0, 31, 32, height - 1}) {
		{
			ExrFile file(at("changed.exr"), width, height, {"B", "G", "R"});
			for (int y = 0; y < height; ++y) {
				auto row = rows[static_cast<size_t>(y)];
				if (y == changed)
					row.back() = row.back() == half(0.5f) ? half(0.25f) : half(0.5f);
				file.add_row(row);
			}
		}
		EXPECT_NE(check_strip(spec(), 0, height, at("whole.exr")), check_strip(spec(), 0, height, at("changed.exr"))) << changed;
	}
}

TEST_F(Exr, StripsThatDoNotFitAreRefused) {
	write(at("whole.exr"), {"B", "G", "R"}, true);
	write(at("grey.exr"), {"Y"}, true);
	cut(Format::exr, at("whole.exr"), 0, 100, at("a.exr"));
	cut(Format::exr, at("whole.exr"), 100, 50, at("b.exr"));
	cut(Format::exr, at("whole.exr"), 90, 60, at("early.exr"));
	cut(Format::exr, at("grey.exr"), 100, 50, at("other.exr"));
	for (const auto& strips : std::vector<std::vector<fs::path>>{{at("a.exr"), at("early.exr")}, {at("a.exr"), at("other.exr")},
			 {at("b.exr"), at("a.exr")}, {at("a.exr"), at("b.exr"), at("b.exr")}, {at("whole.exr"), at("b.exr")}})
		EXPECT_THROW(stitch(spec(), strips, at("joined.exr")), Error);
	JobSpec taller = spec();
	taller.height = height + 1;
	EXPECT_THROW(stitch(taller, {at("a.exr"), at("b.exr")}, at("joined.exr")), Error);
	EXPECT_THROW(check_strip(spec(), 0, 101, at("a.exr")), Error);
	EXPECT_THROW(cut(Format::exr, at("whole.exr"), 140, 11, at("c.exr")), Error);
}

} // namespace
