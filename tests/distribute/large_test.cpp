// SPDX-License-Identifier: AGPL-3.0-or-later
// Frames and strips may be of any size, and so may what a stranger sends in their place: nothing has all their pixels at once.
#include "distribute/common/files.h"
#include "distribute/stitch/picture.h"
#include "distribute/stitch/png_join.h"
#include "tests/distribute/exr_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <functional>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace farm;

class Large : public ::testing::Test {
protected:
	static constexpr int width = 16000, height = 8000; ///< bytes, a row and in all
	ScratchFolder scratch{fs::temp_directory_path()};

	fs::path at(const std::string& name) const { return scratch.path() / name; }
	static JobSpec spec_for(Format format) {
		JobSpec spec;
		spec.format = format;
		spec.width = format == Format::png ? width : width / 2;
		spec.height = spec.strip_rows = height;
		spec.bits = format == Format::png ? 8 : 16;
		return spec;
	}
	void write_png(const fs::path& to) const {
		png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
		png_infop info = png_create_info_struct(png);
		std::FILE* file = std::fopen(to.c_str(), "wb");
		png_init_io(png, file);
		png_set_compression_level(png, 1);
		png_set_filter(png, 0, PNG_FILTER_NONE);
		png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_GRAY, 0, 0, 0);
		png_write_info(png, info);
		const std::vector<png_byte> row(width);
		for (int y = 0; y < height; ++y)
			png_write_row(png, row.data());
		png_write_end(png, info);
		png_destroy_write_struct(&png, &info);
		std::fclose(file);
	}
	/// In a process of its own: that it works, and takes less than half of what all pixels would.
	static void takes_little(const std::function<void()>& work) {
		const pid_t child = ::fork();
		if (child == 0) {
			rusage before{}, after{};
			::getrusage(RUSAGE_SELF, &before);
			try {
				work();
			} catch (const std::exception& e) {
				std::fprintf(stderr, "%s\n", e.what());
				::_exit(2);
			}
			::getrusage(RUSAGE_SELF, &after);
			::_exit(after.ru_maxrss - before.ru_maxrss < width * height / 1024 / 2 ? 0 : 1); // kB
		}
		int status = -1;
		ASSERT_EQ(::waitpid(child, &status, 0), child);
		EXPECT_EQ(status, 0);
	}
};

TEST_F(Large, AWholePng) {
	write_png(at("whole.png"));
	takes_little([&] { check_strip(spec_for(Format::png), 0, height, at("whole.png")); });
}

TEST_F(Large, AStripThatCanBeJoined) {
	write_png(at("whole.png"));
	cut(Format::png, at("whole.png"), 0, height, at("strip.png"));
	ASSERT_TRUE(png::is_joinable(at("strip.png")));
	takes_little([&] { check_strip(spec_for(Format::png), 0, height, at("strip.png")); });
	EXPECT_EQ(check_strip(spec_for(Format::png), 0, height, at("strip.png")),
		check_strip(spec_for(Format::png), 0, height, at("whole.png")));
}

TEST_F(Large, AWholeExrIsCheckedCutAndJoined) {
	const JobSpec spec = spec_for(Format::exr);
	{
		ExrFile file(at("whole.exr"), spec.width, height, {"Y"});
		for (int y = 0; y < height; ++y)
			file.add_row(std::vector<half>(static_cast<size_t>(spec.width)));
	}
	takes_little([&] { check_strip(spec, 0, height, at("whole.exr")); });
	takes_little([&] { cut(Format::exr, at("whole.exr"), 0, height - 1, at("most.exr")); });
	cut(Format::exr, at("whole.exr"), height - 1, 1, at("last.exr"));
	takes_little([&] { stitch(spec, {at("most.exr"), at("last.exr")}, at("joined.exr")); });
	EXPECT_EQ(check_strip(spec, 0, height, at("joined.exr")), check_strip(spec, 0, height, at("whole.exr")));
}

} // namespace
