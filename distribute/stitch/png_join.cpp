// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/stitch/png_join.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/stitch/png_filter.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>

namespace farm::png {
namespace {

using Path = std::filesystem::path;

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view ending("\x03\x00", 2); ///< an empty last block
constexpr size_t sum_bytes = 4, head_bytes = 2;   ///< Adler's sum at the end, zlib's head at the beginning
constexpr int level = 6;
constexpr size_t block_bytes = 1 << 20; ///< unpacked at a time, of what may have gigabytes

const Bytef* bytes_of(std::string_view text) { return reinterpret_cast<const Bytef*>(text.data()); }

void add_number(std::string& to, std::uint32_t n) {
	for (int shift = 24; shift >= 0; shift -= 8)
		to += static_cast<char>(n >> shift & 255);
}

std::uint32_t number_at(std::string_view text) {
	std::uint32_t n = 0;
	for (size_t i = 0; i < 4; ++i)
		n = n << 8 | static_cast<unsigned char>(text.at(i));
	return n;
}

void add_chunk(std::string& to, std::string_view name, std::string_view data) {
	add_number(to, static_cast<std::uint32_t>(data.size()));
	const size_t from = to.size();
	to += name;
	to += data;
	const std::string_view all = std::string_view(to).substr(from);
	add_number(to, static_cast<std::uint32_t>(crc32_z(0, bytes_of(all), all.size())));
}

/// All that stands before the pixels.
std::string head(const Kind& kind, std::uint32_t height, bool joinable) {
	std::string out(signature), data;
	add_number(data, kind.width);
	add_number(data, height);
	for (const int c : {kind.depth, kind.colours, 0, 0, 0})
		data += static_cast<char>(c);
	add_chunk(out, "IHDR", data);
	if (kind.has_gamma) {
		data.clear();
		add_number(data, static_cast<std::uint32_t>(kind.gamma));
		add_chunk(out, "gAMA", data);
	}
	if (kind.has_srgb)
		add_chunk(out, "sRGB", std::string(1, static_cast<char>(kind.intent)));
	if (joinable)
		add_chunk(out, "bhJn", "");
	return out;
}

struct Deflater : z_stream {
	Deflater() : z_stream() {
		if (deflateInit(this, level) != Z_OK)
			throw Error("no memory to pack a picture");
	}
	~Deflater() { deflateEnd(this); }
};
struct Inflater : z_stream {
	Inflater() : z_stream() {
		if (inflateInit(this) != Z_OK)
			throw Error("no memory to unpack a picture");
	}
	~Inflater() { inflateEnd(this); }
};

std::string pack(const std::string& filtered) {
	Deflater z;
	std::string packed(deflateBound(&z, filtered.size()) + 64, 0);
	const auto room = [&] { return static_cast<uInt>(packed.size() - z.total_out); };
	z.next_in = const_cast<Bytef*>(bytes_of(filtered));
	z.avail_in = static_cast<uInt>(filtered.size());
	z.next_out = reinterpret_cast<Bytef*>(packed.data());
	z.avail_out = room();
	const bool good = deflate(&z, Z_FULL_FLUSH) == Z_OK && z.avail_in == 0 && deflate(&z, Z_FINISH) == Z_STREAM_END;
	packed.resize(z.total_out);
	if (!good || packed.compare(packed.size() - sum_bytes - ending.size(), ending.size(), ending) != 0)
		throw Error("zlib did not pack a picture as it should");
	return packed;
}

/// One file taken apart.
struct Parts {
	Kind kind;
	std::uint32_t height = 0;
	bool joinable = false;
	std::string packed;
};

[[noreturn]] void bad(const Path& path, const char* why) { throw Error(path.string() + ": " + why); }

Parts take_apart(const Path& path) {
	const std::string data = read_file(path);
	std::string_view rest(data);
	if (rest.substr(0, signature.size()) != signature)
		bad(path, "it is no PNG");
	rest.remove_prefix(signature.size());
	Parts p;
	for (bool first = true;; first = false) {
		if (rest.size() < 12 || number_at(rest) > rest.size() - 12)
			bad(path, "it is cut short");
		const std::string_view named = rest.substr(4, number_at(rest) + 4), name = named.substr(0, 4), body = named.substr(4);
		if (crc32_z(0, bytes_of(named), named.size()) != number_at(rest.substr(4 + named.size())))
			bad(path, "a checksum is wrong");
		rest.remove_prefix(8 + named.size());
		if (first != (name == "IHDR") || (first && body.size() != 13))
			bad(path, "it has no good header");
		if (name == "IHDR") {
			p.kind.width = number_at(body);
			p.height = number_at(body.substr(4));
			p.kind.depth = body[8];
			p.kind.colours = body[9];
			if (body.substr(10) != std::string_view("\0\0\0", 3))
				bad(path, "it is packed or filtered in a way that povray does not know, or interlaced");
		} else if (name == "gAMA" && body.size() == 4) {
			p.kind.has_gamma = true;
			p.kind.gamma = static_cast<std::int32_t>(number_at(body));
		} else if (name == "sRGB" && body.size() == 1) {
			p.kind.has_srgb = true;
			p.kind.intent = body[0];
		} else if (name == "bhJn") {
			p.joinable = true;
		} else if (name == "IDAT") {
			p.packed += body;
		} else if (name == "IEND") {
			break;
		} else {
			bad(path, "it has what no strip has");
		}
	}
	if (!p.joinable || p.packed.size() < head_bytes + ending.size() + sum_bytes)
		bad(path, "it cannot be joined");
	return p;
}

void write(const Path& path, const std::string& data) {
	std::ofstream out(path, std::ios::binary | std::ios::trunc);
	if (!out.write(data.data(), static_cast<std::streamsize>(data.size())).flush())
		throw system_error("cannot write " + path.string());
}

} // namespace

size_t Kind::step() const {
	const size_t channels = colours == 0 ? 1 : colours == 2 ? 3 : colours == 4 ? 2 : colours == 6 ? 4 : 0;
	if (channels == 0 || (depth != 8 && depth != 16))
		throw Error("a PNG of this kind is none of povray's");
	return channels * static_cast<size_t>(depth) / 8;
}

void write_joinable(const Path& strip, const Kind& kind, const std::string& pixels) {
	const size_t bytes = kind.row_bytes(), rows = pixels.size() / bytes;
	std::string filtered(rows * (bytes + 1), 0);
	if (filtered.size() > std::numeric_limits<uInt>::max() / 2)
		throw Error(strip.string() + " is too large for one strip");
	const auto* in = bytes_of(pixels);
	for (size_t y = 0; y < rows; ++y)
		filter(in + y * bytes, y ? in + (y - 1) * bytes : nullptr, bytes, kind.step(),
			reinterpret_cast<Byte*>(filtered.data()) + y * (bytes + 1));
	std::string out = head(kind, static_cast<std::uint32_t>(rows), true);
	add_chunk(out, "IDAT", pack(filtered));
	add_chunk(out, "IEND", "");
	write(strip, out);
}

bool is_joinable(const Path& strip) {
	std::ifstream in(strip, std::ios::binary);
	if (!in)
		throw system_error("cannot read " + strip.string());
	std::string start(128, 0); // the chunks before it are known, and short
	in.read(start.data(), static_cast<std::streamsize>(start.size()));
	start.resize(static_cast<size_t>(in.gcount()));
	const size_t mark = start.find("bhJn"), pixels = start.find("IDAT");
	return mark != std::string::npos && (pixels == std::string::npos || mark < pixels);
}

void read_joinable(const Path& strip, const std::function<void(const Kind&, std::uint32_t)>& begin,
	const std::function<void(std::string_view)>& each) {
	const Parts p = take_apart(strip);
	begin(p.kind, p.height);
	const size_t bytes = p.kind.row_bytes(), body = p.packed.size() - ending.size() - sum_bytes;
	if (p.packed.size() > std::numeric_limits<uInt>::max())
		bad(strip, "it is larger than a strip may be");
	const size_t some = std::max<size_t>(1, block_bytes / (bytes + 1));
	std::string filtered, pixels, above(bytes, 0);
	Inflater z;
	z.next_in = const_cast<Bytef*>(bytes_of(p.packed));
	z.avail_in = static_cast<uInt>(body);
	for (size_t done = 0; done < p.height;) {
		const size_t rows = std::min(some, p.height - done);
		filtered.resize(rows * (bytes + 1));
		pixels.resize(rows * bytes);
		z.next_out = reinterpret_cast<Bytef*>(filtered.data());
		z.avail_out = static_cast<uInt>(filtered.size());
		const int status = inflate(&z, Z_NO_FLUSH);
		if ((status != Z_OK && status != Z_BUF_ERROR) || z.avail_out > 0)
			bad(strip, "it cannot be joined as it says");
		auto* out = reinterpret_cast<Byte*>(pixels.data());
		for (size_t y = 0; y < rows; ++y) {
			const Byte* row = bytes_of(filtered) + y * (bytes + 1);
			const bool first = done == 0 && y == 0;
			if (!unfilter(first && *row >= 2 ? -1 : *row, row + 1, y ? out + (y - 1) * bytes : bytes_of(above), bytes,
					p.kind.step(), out + y * bytes))
				bad(strip, "a row is filtered as it may not be");
		}
		above.assign(pixels, pixels.size() - bytes, bytes);
		each(pixels);
		done += rows;
	}
	// data_type: bits left of the last byte; 128: between two blocks; 64: in the last (zlib.h, inflate).
	if (z.avail_in > 0 || z.data_type != 128 || p.packed.compare(body, ending.size(), ending) != 0)
		bad(strip, "it cannot be joined as it says");
	Byte none = 0; // there must be nothing more
	z.avail_in = static_cast<uInt>(ending.size() + sum_bytes);
	z.next_out = &none;
	z.avail_out = 1;
	if (inflate(&z, Z_FINISH) != Z_STREAM_END || z.avail_in > 0 || z.avail_out == 0)
		bad(strip, "its pixels are damaged");
}

void join(const std::vector<Path>& strips, int height, const Path& picture) {
	std::ofstream out(picture, std::ios::binary | std::ios::trunc);
	Kind kind;
	std::uint32_t done = 0;
	uLong sum = adler32(0, nullptr, 0);
	std::string piece;
	for (const Path& strip : strips) {
		const Parts p = take_apart(strip);
		const bool first = &strip == &strips.front();
		piece = first ? head(p.kind, static_cast<std::uint32_t>(height), false) : "";
		kind = first ? p.kind : kind;
		if (!(p.kind == kind))
			bad(strip, "it is of another kind than those before");
		const std::string_view packed(p.packed);
		const size_t from = first ? 0 : head_bytes, to = packed.size() - ending.size() - sum_bytes;
		add_chunk(piece, "IDAT", packed.substr(from, to - from));
		const auto bytes = static_cast<z_off_t>(p.height * (kind.row_bytes() + 1));
		sum = adler32_combine(sum, number_at(packed.substr(to + ending.size())), bytes);
		done += p.height;
		out << piece;
	}
	if (done != static_cast<std::uint32_t>(height))
		throw Error(picture.string() + ": its strips have " + std::to_string(done) + " rows");
	piece = ending;
	add_number(piece, static_cast<std::uint32_t>(sum));
	std::string tail;
	add_chunk(tail, "IDAT", piece);
	add_chunk(tail, "IEND", "");
	if (!(out << tail).flush())
		throw system_error("cannot write " + picture.string());
}

} // namespace farm::png
