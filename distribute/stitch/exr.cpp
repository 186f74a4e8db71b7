// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/protocol/fields.h"
#include "distribute/stitch/picture.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

namespace farm::exr {
namespace {

using Path = std::filesystem::path;

size_t size_of(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

/// The channels of some rows, one after the other as the file has them.
struct Pixels {
	int width = 0, left = 0, first = 0, rows = 0; ///< as counted in the frame
	std::vector<std::pair<std::string, Imf::PixelType>> channels;
	std::vector<std::vector<char>> data;

	size_t row_bytes(size_t channel) const { return size_of(channels[channel].second) * static_cast<size_t>(width); }
	Imf::FrameBuffer buffer() {
		Imf::FrameBuffer all;
		for (size_t c = 0; c < channels.size(); ++c) {
			const size_t one = size_of(channels[c].second), row = row_bytes(c);
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

/// What rows of the file are made of; none of them is read yet.
Pixels shape(const Imf::InputFile& file) {
	const auto window = file.header().dataWindow();
	Pixels p;
	p.width = window.max.x - window.min.x + 1;
	p.left = window.min.x;
	const auto& list = file.header().channels();
	for (auto c = list.begin(); c != list.end(); ++c)
		p.channels.emplace_back(c.name(), c.channel().type);
	if (p.channels.size() > 4)
		throw Error(std::string(file.fileName()) + " has more channels than povray writes");
	p.data.resize(p.channels.size());
	return p;
}

/// Reads these rows, some at a time, for a frame may have gigabytes; `each` gets them.
template <class Each> void read(Imf::InputFile& file, Pixels p, int row, int rows, Each each) {
	constexpr int some = 32; // as many as OpenEXR packs together at most
	const auto window = file.header().dataWindow();
	if (row < window.min.y || row + rows - 1 > window.max.y)
		throw Error(std::string(file.fileName()) + " has rows " + std::to_string(window.min.y) + " to " +
					std::to_string(window.max.y) + "; " + std::to_string(row) + " to " + std::to_string(row + rows - 1) +
					" are needed");
	for (p.first = row; p.first < row + rows; p.first += p.rows) {
		p.rows = std::min(some, row + rows - p.first);
		file.setFrameBuffer(p.buffer());
		file.readPixels(p.first, p.first + p.rows - 1);
		each(p);
	}
}

/// The header of a picture of these rows that are written in order, whatever the order was where it is from.
Imf::Header header_for(Imf::Header header, int row, int rows) {
	auto window = header.dataWindow();
	window.min.y = row;
	window.max.y = row + rows - 1;
	header.dataWindow() = window;
	header.lineOrder() = Imf::INCREASING_Y;
	return header;
}

void write(Imf::OutputFile& file, Pixels& p) {
	file.setFrameBuffer(p.buffer());
	file.writePixels(p.rows);
}

/// A picture from a stranger (or from his scene), before OpenEXR believes what it says: it would make room for whatever size an
/// attribute or a window claims to have.
class Header {
public:
	explicit Header(const Path& path) {
		std::ifstream file(path, std::ios::binary);
		text.resize(1 << 16); // povray's have 400 bytes
		file.read(text.data(), static_cast<std::streamsize>(text.size()));
		text.resize(static_cast<size_t>(file.gcount()));
		// The magic number, version 2, and no flag: scan lines, one part, short names.
		if (text.compare(0, 8, std::string("v/1\1\2\0\0\0", 8)) != 0)
			throw Error("it is no EXR of povray's kind");
		at = 8;
		for (std::string name = word(); !name.empty(); name = word()) {
			const std::string type = word();
			const std::int32_t size = number();
			if (size < 0 || static_cast<size_t>(size) > text.size() - at)
				throw Error("its header is damaged");
			const size_t next = at + static_cast<size_t>(size);
			// OpenEXR reads what the type needs, whatever the size says.
			static const std::map<std::string, std::int32_t> sizes = {
				{"compression", 1}, {"lineOrder", 1}, {"float", 4}, {"v2f", 8}, {"box2i", 16}, {"chromaticities", 32}};
			if (type == "chlist")
				while (!word().empty())
					at += 16;
			else if (const auto known = sizes.find(type); type != "string" && (known == sizes.end() || known->second != size))
				throw Error("its header is none of povray's");
			if (type == "box2i")
				for (auto& edge : windows[name])
					if (edge = number(); edge < 0 || edge >= limits::pixels)
						throw Error("its header is damaged");
			if (at > next || (type == "chlist" && at != next))
				throw Error("its header is damaged");
			at = next;
		}
	}
	/// left, top, right, bottom of dataWindow or displayWindow.
	const std::array<std::int32_t, 4>& window(const std::string& name) { return windows[name]; }

private:
	std::string word() {
		const size_t end = text.find('\0', at);
		if (end == std::string::npos)
			throw Error("its header is damaged");
		const std::string w = text.substr(at, end - at);
		at = end + 1;
		return w;
	}
	std::int32_t number() {
		std::uint32_t n = 0;
		if (text.size() - at < 4)
			throw Error("its header is damaged");
		for (int i = 0; i < 4; ++i)
			n |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[at++])) << (8 * i);
		return static_cast<std::int32_t>(n);
	}

	std::string text;
	size_t at = 0;
	std::map<std::string, std::array<std::int32_t, 4>> windows;
};

/// OpenEXR's own exceptions, as ours.
template <class Function> auto guarded(const Path& path, Function function) {
	try {
		return function();
	} catch (const Error&) {
		throw;
	} catch (const std::exception& e) {
		const std::string why = e.what();
		throw Error(path.string() + ": " + shown(why), why.find(std::strerror(ENOSPC)) == std::string::npos ? 0 : ENOSPC);
	}
}

} // namespace

void cut(const Path& whole, int row, int rows, const Path& strip) {
	guarded(whole, [&] {
		const Header believable(whole);
		Imf::InputFile in(whole.c_str(), 0);
		Imf::OutputFile out(strip.c_str(), header_for(in.header(), row, rows), 0);
		read(in, shape(in), row, rows, [&](Pixels& p) { write(out, p); });
	});
}

std::string check_strip(const JobSpec& spec, int row, int rows, const Path& strip) {
	return guarded(strip, [&] {
		Header header(strip);
		const std::array<std::int32_t, 4> frame = {0, 0, spec.width - 1, spec.height - 1},
										  part = {0, row, spec.width - 1, row + rows - 1};
		if (header.window("displayWindow") != frame || header.window("dataWindow") != part)
			throw Error("the strip has other rows or another width than it should");
		Imf::InputFile in(strip.c_str(), 0);
		const Pixels kind = shape(in);
		for (const auto& [name, type] : kind.channels)
			if (size_of(type) * 8 != static_cast<size_t>(spec.bits))
				throw Error("the strip's channel " + name + " has not " + std::to_string(spec.bits) + " bits");
		Sha256 name;
		name.add("exr " + kind.kind() + "\n");
		read(in, kind, row, rows, [&](Pixels& p) {
			for (size_t y = 0; y < static_cast<size_t>(p.rows); ++y)
				for (size_t c = 0; c < p.data.size(); ++c)
					name.add({p.data[c].data() + y * p.row_bytes(c), p.row_bytes(c)});
		});
		return name.name();
	});
}

std::string kind_of(const Path& strip) {
	return guarded(strip, [&] {
		const Header believable(strip);
		const Imf::InputFile in(strip.c_str(), 0);
		std::string all = "EXR with";
		for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c)
			all += std::string(" ") + c.name() +
				   (c.channel().type == Imf::HALF       ? " half"
					   : c.channel().type == Imf::FLOAT ? " float"
														: " uint");
		return all;
	});
}

void stitch(const JobSpec& spec, const std::vector<Path>& strips, const Path& picture) {
	guarded(picture, [&] {
		std::optional<Imf::OutputFile> out;
		Pixels kind;
		int done = 0, top = 0;
		for (const auto& strip : strips) {
			Imf::InputFile in(strip.c_str(), 0);
			const auto window = in.header().dataWindow();
			const Pixels here = shape(in);
			const int rows = window.max.y - window.min.y + 1;
			if (!out) {
				kind = here;
				top = window.min.y;
				out.emplace(picture.c_str(), header_for(in.header(), top, spec.height), 0);
			}
			if (here.kind() != kind.kind() || here.width != kind.width || window.min.y != top + done || done + rows > spec.height)
				throw Error(strip.string() + " does not go on where the one before it ends");
			read(in, here, window.min.y, rows, [&](Pixels& p) { write(*out, p); });
			done += rows;
		}
		if (done != spec.height)
			throw Error(picture.string() + ": its strips have " + std::to_string(done) + " rows");
	});
}

} // namespace farm::exr
