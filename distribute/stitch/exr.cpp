// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/stitch/picture.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

namespace farm::exr {
namespace {

using Path = std::filesystem::path;

size_t size_of(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

/// The channels of some rows, one after the other as the file has them.
struct Pixels {
	int width = 0, first = 0, rows = 0; ///< rows as counted in the frame
	std::vector<std::pair<std::string, Imf::PixelType>> channels;
	std::vector<std::vector<char>> data;

	Imf::FrameBuffer buffer(int left) {
		Imf::FrameBuffer all;
		for (size_t c = 0; c < channels.size(); ++c) {
			const size_t one = size_of(channels[c].second), row = one * static_cast<size_t>(width);
			data[c].resize(row * static_cast<size_t>(rows));
			// OpenEXR counts from pixel (0, 0) of the frame.
			char* origin = data[c].data() - static_cast<std::ptrdiff_t>(row) * first - static_cast<std::ptrdiff_t>(one) * left;
			all.insert(channels[c].first, Imf::Slice(channels[c].second, origin, one, row));
		}
		return all;
	}
	std::string kind() const {
		std::string text;
		for (const auto& [name, type] : channels)
			text += name + ":" + std::to_string(type) + " ";
		return text;
	}
};

Pixels read(Imf::InputFile& file, int row, int rows) {
	const auto window = file.header().dataWindow();
	Pixels p;
	p.width = window.max.x - window.min.x + 1;
	p.first = row;
	p.rows = rows;
	if (row < window.min.y || row + rows - 1 > window.max.y)
		throw Error(std::string(file.fileName()) + " has rows " + std::to_string(window.min.y) + " to " +
					std::to_string(window.max.y) + "; " + std::to_string(row) + " to " + std::to_string(row + rows - 1) +
					" are needed");
	const auto& list = file.header().channels();
	for (auto c = list.begin(); c != list.end(); ++c)
		p.channels.emplace_back(c.name(), c.channel().type);
	p.data.resize(p.channels.size());
	file.setFrameBuffer(p.buffer(window.min.x));
	file.readPixels(row, row + rows - 1);
	return p;
}

void write(const Path& path, Imf::Header header, Pixels& p, int left) {
	auto window = header.dataWindow();
	window.min.y = p.first;
	window.max.y = p.first + p.rows - 1;
	header.dataWindow() = window;
	Imf::OutputFile out(path.c_str(), header, 0);
	out.setFrameBuffer(p.buffer(left));
	out.writePixels(p.rows);
}

/// OpenEXR's own exceptions, as ours.
template <class Function> auto guarded(const Path& path, Function function) {
	try {
		return function();
	} catch (const Error&) {
		throw;
	} catch (const std::exception& e) {
		throw Error(path.string() + ": " + e.what());
	}
}

} // namespace

void cut(const Path& whole, int row, int rows, const Path& strip) {
	guarded(whole, [&] {
		Imf::InputFile in(whole.c_str(), 0);
		Pixels p = read(in, row, rows);
		write(strip, in.header(), p, in.header().dataWindow().min.x);
	});
}

std::string check_strip(const JobSpec& spec, int row, int rows, const Path& strip) {
	return guarded(strip, [&] {
		Imf::InputFile in(strip.c_str(), 0);
		const auto window = in.header().dataWindow(), frame = in.header().displayWindow();
		if (window.max.x - window.min.x + 1 != spec.width || window.min.y != row || window.max.y != row + rows - 1 ||
			frame.max.y - frame.min.y + 1 != spec.height)
			throw Error("the strip has other rows or another width than it should");
		Pixels p = read(in, row, rows);
		std::string all = "exr " + p.kind() + "\n";
		for (const auto& [name, type] : p.channels)
			if (size_of(type) * 8 != static_cast<size_t>(spec.bits))
				throw Error("the strip's channel " + name + " has not " + std::to_string(spec.bits) + " bits");
		for (const auto& channel : p.data)
			all.append(channel.data(), channel.size());
		return sha256(all);
	});
}

void stitch(const JobSpec& spec, const std::vector<Path>& strips, const Path& picture) {
	guarded(picture, [&] {
		Pixels all;
		Imf::Header header;
		int left = 0;
		for (const auto& strip : strips) {
			Imf::InputFile in(strip.c_str(), 0);
			const auto window = in.header().dataWindow();
			Pixels p = read(in, window.min.y, window.max.y - window.min.y + 1);
			if (all.channels.empty()) {
				header = in.header();
				left = window.min.x;
				all = std::move(p);
				continue;
			}
			if (p.kind() != all.kind() || p.width != all.width || p.first != all.first + all.rows)
				throw Error(strip.string() + " does not go on where the one before it ends");
			for (size_t c = 0; c < p.data.size(); ++c)
				all.data[c].insert(all.data[c].end(), p.data[c].begin(), p.data[c].end());
			all.rows += p.rows;
		}
		if (all.rows != spec.height)
			throw Error(picture.string() + ": its strips have " + std::to_string(all.rows) + " rows");
		write(picture, header, all, left);
	});
}

} // namespace farm::exr
