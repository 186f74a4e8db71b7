// SPDX-License-Identifier: AGPL-3.0-or-later
/// An EXR as povray writes them, by OpenEXR alone.
#ifndef TESTS_EXR_FILE_H
#define TESTS_EXR_FILE_H

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <filesystem>
#include <string>
#include <vector>

namespace farm {

class ExrFile {
public:
	/// Channels of half floats, in the order of their names. From the top row down, or from the last one up.
	ExrFile(const std::filesystem::path& to, int w, int h, const std::vector<std::string>& names, bool down = true)
		: width(w), channels(names), file(to.c_str(), header(w, h, names, down), 0) {}
	/// One channel after the other.
	void add_row(std::vector<half> values) {
		Imf::FrameBuffer buffer;
		for (size_t c = 0; c < channels.size(); ++c) // stride 0: one row's place serves for all
			buffer.insert(channels[c],
				Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data() + c * static_cast<size_t>(width)), sizeof(half), 0));
		file.setFrameBuffer(buffer);
		file.writePixels(1);
	}

private:
	static Imf::Header header(int w, int h, const std::vector<std::string>& names, bool down) {
		Imf::Header all(w, h);
		all.compression() = Imf::RLE_COMPRESSION;
		all.lineOrder() = down ? Imf::INCREASING_Y : Imf::DECREASING_Y;
		for (const auto& name : names)
			all.channels().insert(name, Imf::Channel(Imf::HALF));
		return all;
	}

	int width;
	std::vector<std::string> channels;
	Imf::OutputFile file;
};

} // namespace farm
#endif
