// SPDX-License-Identifier: AGPL-3.0-or-later
// The fuzz target without clang: good inputs, then so many damaged ones. A count, as what is tried must not hang on the machine.
//   farm_fuzz COUNT [SEED]         0: the good ones alone
//   farm_fuzz --write FOLDER       the good ones as files, to start libFuzzer from
#include "distribute/common/files.h"
#include "distribute/protocol/messages.h"
#include "tests/distribute/good_job.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>

using namespace farm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

std::string exr(Imf::PixelType type, const char* channels) {
	Imf::Header header(5, 6);
	header.dataWindow().min.y = 3;
	header.insert("software", Imf::StringAttribute("POV-Ray"));
	const std::string names = channels;
	std::vector<float> pixels(names.size() * 5 * 3, 0.25F);
	Imf::FrameBuffer buffer;
	const size_t one = type == Imf::HALF ? 2 : 4;
	for (size_t c = 0; c < names.size(); ++c) {
		const std::string name(1, names[c]);
		header.channels().insert(name, Imf::Channel(type));
		char* start = reinterpret_cast<char*>(pixels.data() + c * 15);
		buffer.insert(name, Imf::Slice(type, start - 3 * 5 * static_cast<std::ptrdiff_t>(one), one, 5 * one));
	}
	const ScratchFolder scratch(fs::temp_directory_path());
	{
		Imf::OutputFile out((scratch.path() / "x.exr").c_str(), header, 0);
		out.setFrameBuffer(buffer);
		out.writePixels(3);
	}
	return read_file(scratch.path() / "x.exr");
}

std::string png(int depth, int colours) {
	std::string all;
	png_structp out = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
	png_infop info = png_create_info_struct(out);
	png_set_write_fn(
		out, &all,
		[](png_structp p, png_bytep data, size_t size) {
			static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
		},
		nullptr);
	png_set_IHDR(out, info, 5, 3, depth, colours, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	png_set_gAMA(out, info, 0.45455);
	png_write_info(out, info);
	png_byte row[5 * 8];
	for (int y = 0; y < 3; ++y) {
		for (size_t i = 0; i < sizeof row; ++i)
			row[i] = static_cast<png_byte>(37 * i + static_cast<size_t>(y));
		png_write_row(out, row);
	}
	png_write_end(out, info);
	png_destroy_write_struct(&out, &info);
	return all;
}

std::vector<std::string> good() {
	JobSpec spec = good_job();
	spec.width = 5;
	spec.height = 6;
	spec.strip_rows = 3;
	Task task;
	task.lease = task.job = task.rows = 1;
	task.spec = spec;
	const Bundle bundle{"up", {{"up/x.pov", std::string(64, 'b'), 5}, {"y.inc", std::string(64, 'c'), 0}}};
	const std::vector<std::pair<char, std::string>> inputs = {{0, json(spec).dump()}, {0, json(task).dump()},
		{0, json(bundle).dump()}, {0, json(Hello{"0123456789abcdef", "n", 2, "POV-Ray 3.7", "p"}).dump()},
		{0, json(Failure{"Parse Error: x", "log\n"}).dump()}, {1, "/v1/jobs/7/frames/a%20b.png?x=1&y=%2F+z"},
		{1, "/v1/leases/42949672961/strip?sha256=abc&seconds=1.5"}, {1, "/health"},
		{2, "Input_File_Name=film.pov\n+W640 +H480 +A0.3 -J ; a comment\n[High]\nWidth=1280\nDeclare=A=1, "
			"B=2\nOutput_File_Name=\"a b\"\n"},
		{2, "+KFF24 +KI0.5 +L/usr/x +O'out put.png'\r\nPost_Frame_Command=rm \"x\" \nFinal_Frame = 10\n"},
		{3, png(8, PNG_COLOR_TYPE_RGB)}, {3, png(8, PNG_COLOR_TYPE_RGBA)}, {3, png(8, PNG_COLOR_TYPE_GRAY)},
		{4, png(16, PNG_COLOR_TYPE_RGB)}, {4, png(16, PNG_COLOR_TYPE_GRAY_ALPHA)}, {5, exr(Imf::HALF, "RGB")},
		{5, exr(Imf::HALF, "RGBA")}, {6, exr(Imf::FLOAT, "RGB")}, {6, exr(Imf::UINT, "RGB")}, {7, "authorization: Bearer #\n"},
		{7, "host: lab:7700\ncookie: a=1; bhfarm-7700=@; b=2\norigin: http://lab:7700\n"},
		{7, "host: lab\ncookie: bhfarm-7700=@\nsec-fetch-site: same-origin\n"}};
	std::vector<std::string> all;
	for (const auto& [kind, text] : inputs)
		all.push_back(std::string(1, kind) + text);
	return all;
}

/// A few bytes changed, left out, doubled, or taken from another input.
std::string damaged(std::string text, const std::vector<std::string>& others, std::mt19937& random) {
	const auto below = [&](size_t n) { return n ? random() % n : 0; };
	static const std::string marks[] = {"\"", "{", "[", "]}", "%", "%2e%2e/", "../", "0", "-1", "99999999999999999999", "1e999",
		"\xff", "\n", "=", ",", "\\u0000", "null"};
	for (size_t n = 1 + below(4); n > 0; --n) {
		const size_t at = 1 + below(text.size() - 1), most = text.size() - at;
		switch (below(7)) {
		case 0:
			if (at < text.size())
				text[at] = static_cast<char>(random());
			break;
		case 1:
			if (at < text.size())
				text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
			break;
		case 2:
			text.erase(at, below(std::min<size_t>(most, 16) + 1));
			break;
		case 3:
			text.insert(at, marks[below(std::size(marks))]);
			break;
		case 4:
			text.insert(at, text.substr(at, below(64)));
			break;
		case 5: {
			const std::string& other = others[below(others.size())];
			text.insert(at, other, below(other.size()), below(32));
			break;
		}
		case 6: // a number's bytes, as headers have them
			for (size_t i = at; i < std::min(at + 4, text.size()); ++i)
				text[i] = static_cast<char>(below(2) ? 0xff : 0);
			break;
		}
	}
	return text;
}

void run(const std::string& input) { LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size()); }

} // namespace

int main(int argc, char** argv) {
	const std::vector<std::string> seeds = good();
	if (argc == 3 && std::string(argv[1]) == "--write") {
		for (size_t i = 0; i < seeds.size(); ++i)
			std::ofstream(fs::path(argv[2]) / ("good" + std::to_string(i)), std::ios::binary) << seeds[i];
		return 0;
	}
	const long all = argc > 1 ? std::atol(argv[1]) : 0;
	std::mt19937 random(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1);
	for (const auto& seed : seeds)
		run(seed);
	for (long count = 0; count < all; ++count) {
		const std::string input = damaged(seeds[random() % seeds.size()], seeds, random);
		// What brings us down is in this file then.
		if (std::getenv("FARM_FUZZ_LAST"))
			std::ofstream(std::getenv("FARM_FUZZ_LAST"), std::ios::binary) << input;
		run(input);
	}
	std::printf("%zu good inputs, %ld damaged ones\n", seeds.size(), all);
	return 0;
}
