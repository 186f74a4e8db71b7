// SPDX-License-Identifier: AGPL-3.0-or-later
// Stands in for povray where a test is about the farm: a picture whose every pixel follows from its frame and place, in a
// millisecond. Its own name says what it is like: liar (other pixels than the others, but for the probe), sleeper (never
// ends), anything else (good). A job's option Declare=pause=MS makes it take so long, Declare=fail=1 makes it fail.
#include <png.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace {

// SplitMix64's finalizer: any function would do.
std::uint64_t mixed(std::uint64_t z) {
	z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
	z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
	return z ^ (z >> 31);
}

void write(const std::string& name, int width, int height, int from, int to, std::uint64_t frame) {
	std::FILE* file = std::fopen(name.c_str(), "wb");
	png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
	png_infop info = png_create_info_struct(png);
	if (!file || setjmp(png_jmpbuf(png))) {
		std::perror(("standin: cannot write " + name).c_str());
		std::exit(1);
	}
	png_init_io(png, file);
	png_set_compression_level(png, 1);
	png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 16, PNG_COLOR_TYPE_RGB,
		PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	png_write_info(png, info);
	std::vector<png_byte> row(static_cast<size_t>(width) * 6);
	for (int y = 0; y < height; ++y) {
		for (size_t i = 0; i < row.size(); ++i) // rows that are not asked for are black, as povray's
			row[i] = y >= from && y < to ? static_cast<png_byte>(mixed((frame << 40) + (static_cast<std::uint64_t>(y) << 20) + i))
										 : png_byte{0};
		png_write_row(png, row.data());
	}
	png_write_end(png, info);
	if (std::fclose(file) != 0) {
		std::perror(("standin: cannot write " + name).c_str());
		std::exit(1);
	}
}

} // namespace

int main(int argc, char** argv) {
	if (argc > 1 && std::string(argv[1]) == "--version") {
		std::puts("POV-Ray 3.7 stand-in");
		return 0;
	}
	const std::string self = argv[0], name = self.substr(self.rfind('/') + 1);
	const char* ini = std::getenv("POVINI");
	std::ifstream lines(ini ? ini : "");
	std::map<std::string, std::string> keys;
	for (std::string line; std::getline(lines, line);) {
		const size_t equals = line.find('=', line.rfind("Declare=", 0) == 0 ? 8 : 0);
		if (equals != std::string::npos)
			keys[line.substr(0, equals)] = line.substr(equals + 1);
	}
	const auto number = [&](const char* key, int otherwise) {
		return keys.count(key) ? std::atoi(keys[key].c_str()) : otherwise;
	};
	std::string output = keys["Output_File_Name"];
	if (output.size() > 1 && output.front() == '"')
		output = output.substr(1, output.size() - 2);
	const int width = number("Width", 0), height = number("Height", 0);
	if (output.empty() || width <= 0 || height <= 0) {
		std::fputs("standin: Parse Error: POVINI says no size or output\n", stderr);
		return 1;
	}
	if (keys.count("Declare=fail")) {
		std::fputs("standin: Parse Error: told to fail\n", stderr);
		return 1;
	}
	const bool probe = keys["Input_File_Name"].find("probe.pov") != std::string::npos;
	if (name == "sleeper" && !probe)
		std::this_thread::sleep_for(std::chrono::hours(10));
	std::this_thread::sleep_for(std::chrono::milliseconds(number("Declare=pause", 0)));
	const int first = number("Start_Row", 1), last = number("End_Row", height); // 1.5, for 1, is 1
	const auto frame = static_cast<std::uint64_t>(number("Subset_Start_Frame", 0)) + (name == "liar" && !probe ? 1000 : 0);
	write(output, width, height, first - 1, last, frame);
	return 0;
}
