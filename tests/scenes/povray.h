// SPDX-License-Identifier: AGPL-3.0-or-later
/// Runs povray on a scene given as text, and reads what comes out.
#ifndef TESTS_POVRAY_H
#define TESTS_POVRAY_H

#include <cstdint>
#include <string>
#include <vector>

struct Picture {
	int width = 0, height = 0;
	std::vector<std::uint16_t> samples; ///< red, green, blue; linear, 16 bits

	/// A sample in [0, 1]; channel 0 red, 1 green, 2 blue.
	double at(int x, int y, int channel) const { return samples[std::size_t((y * width + x) * 3 + channel)] / 65535.0; }
	bool black(int x, int y) const { return at(x, y, 0) + at(x, y, 1) + at(x, y, 2) == 0; }
	bool operator==(const Picture& o) const { return width == o.width && height == o.height && samples == o.samples; }
};

struct Rendering {
	int exit_code = 0;
	std::string text;   ///< what was printed, from parsing on
	std::string folder; ///< where it ran; removed when the process ends
	Picture picture;    ///< empty if none was written
};

/// Renders the scene (a `#version 3.7; global_settings { assumed_gamma 1 }` is put before it) with one thread and no
/// antialiasing; words are appended to the command line. The run has a folder of its own.
Rendering povray(const std::string& scene, int width, int height, const std::string& words = "");

/// A picture as POV-Ray writes it with +FP16; empty if it is none.
Picture read_ppm(const std::string& file);

/// What was printed, without the console's line breaks.
std::string joined(const std::string& text);

/// Number with enough digits to be read back as the same double.
std::string number(double value);

#endif
