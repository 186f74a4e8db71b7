// SPDX-License-Identifier: AGPL-3.0-or-later
// The job that the crowd works on.
#include "distribute/common/files.h"
#include "distribute/common/hash.h"
#include "distribute/stitch/picture.h"
#include "tests/distribute/crowd/crowd.h"

#include <nlohmann/json.hpp>
#include <png.h>

#include <cmath>
#include <memory>
#include <random>

namespace crowd {

std::string make_strip(int width, int rows) {
	std::minstd_rand chance(1);
	std::vector<unsigned char> pixels;
	for (int y = 0; y < rows; ++y)
		for (int x = 0; x < width; ++x)
			for (int c = 0; c < 3; ++c) // a sky's slow waves under a film's grain
				pixels.push_back(static_cast<unsigned char>(120 + 80 * std::sin(0.01 * x + 0.02 * y + c) + chance() / 1024 % 6));
	png_image image{};
	image.version = PNG_IMAGE_VERSION;
	image.width = static_cast<png_uint_32>(width);
	image.height = static_cast<png_uint_32>(rows);
	image.format = PNG_FORMAT_RGB;
	const farm::ScratchFolder scratch(farm::fs::temp_directory_path());
	const farm::fs::path whole = scratch.path() / "whole.png", strip = scratch.path() / "strip.png";
	if (!png_image_write_to_file(&image, whole.c_str(), 0, pixels.data(), 0, nullptr))
		throw std::runtime_error(image.message);
	farm::cut(farm::Format::png, whole, 0, rows, strip); // as workers do
	return farm::read_file(strip);
}

Awaitable<long> submit(Line& line, int width, int rows, int strips_per_frame, int frames) {
	const std::string scene = "camera { }\n";
	farm::Bundle bundle;
	bundle.files.push_back({"scene.pov", farm::sha256(scene), static_cast<std::int64_t>(scene.size())});
	farm::JobSpec spec;
	spec.name = "crowd";
	spec.bundle = bundle.id();
	spec.options = {"Input_File_Name=scene.pov"};
	spec.width = width;
	spec.height = rows * strips_per_frame;
	spec.strip_rows = rows;
	spec.animation = true;
	spec.first = 1;
	spec.last = frames;
	spec.digits = 6;
	const std::string list = farm::json(bundle).dump(), job = farm::json(spec).dump();
	bool good = co_await line.ask("POST", "/v1/bundles", list) == 201;
	good = good && co_await line.ask("PUT", "/v1/files/" + bundle.files[0].sha256, scene) == 201;
	good = good && co_await line.ask("POST", "/v1/jobs", job) == 201;
	if (!good)
		throw std::runtime_error("the server takes no job: " + line.answer);
	co_return number_in(line.answer, "job");
}

} // namespace crowd
