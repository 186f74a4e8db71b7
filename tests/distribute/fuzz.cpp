// SPDX-License-Identifier: AGPL-3.0-or-later
// Whatever strangers send must be taken or refused with one line, and what is taken must be what it seems. Built by clang's
// libFuzzer (fuzz.sh) and by fuzz_replay.cpp.
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/http/door.h"
#include "distribute/http/router.h"
#include "distribute/protocol/fields.h"
#include "distribute/protocol/messages.h"
#include "distribute/scene/ini.h"
#include "distribute/stitch/picture.h"

#include <nlohmann/json.hpp>

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace farm;

namespace {

[[noreturn]] void fail(const std::string& what, const std::string& input) {
	std::fprintf(stderr, "fuzz: %s: %s\n", what.c_str(), json(input).dump(-1, ' ', true, json::error_handler_t::replace).c_str());
	std::abort();
}

/// Does it, or is refused in one line. A command line's own words may be repeated as they are: `say` makes one line of them.
template <class Function> void refused_or(const std::string& input, Function function, bool own_words = false) {
	try {
		function();
	} catch (const Error& e) {
		if ((!own_words && std::string(e.what()).find('\n') != std::string::npos) || !*e.what())
			fail(std::string("a refusal is not one line: ") + e.what(), input);
	} catch (const HttpError& e) {
		if (e.status < 400 || e.status > 499)
			fail(e.what(), input);
	}
}

/// A folder in memory where there is one: each input is a file.
const fs::path& place() {
	static const ScratchFolder scratch(fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path());
	static const bool there = [] {
		fs::current_path(scratch.path());
		return true;
	}();
	(void)there;
	return scratch.path();
}

void put(const fs::path& file, const std::string& data) {
	std::ofstream out(file, std::ios::binary);
	out.write(data.data(), static_cast<std::streamsize>(data.size()));
	if (!out.flush())
		fail("no space to fuzz in", file.string());
}

template <class T> void message(const json& object, const std::string& input) {
	refused_or(input, [&] {
		const T taken = object.get<T>();
		const json again = taken;
		if (json(again.get<T>()) != again)
			fail("a message does not come back as it was", again.dump());
	});
}

void messages(const std::string& input) {
	refused_or(input, [&] {
		const json object = parse_object(input);
		message<JobSpec>(object, input);
		message<Hello>(object, input);
		message<Task>(object, input);
		message<Failure>(object, input);
		message<Bundle>(object, input);
		refused_or(input, [&] {
			const Bundle bundle = object.get<Bundle>();
			for (const auto& file : bundle.files)
				if (const fs::path path = fs::path("/root/of/it") / file.name;
					path.lexically_normal().string().rfind("/root/of/it/", 0) != 0)
					fail("a file of a bundle leads out", file.name);
		});
		refused_or(input, [&] {
			const JobSpec spec = object.get<JobSpec>();
			if (spec.strips() < 1 || spec.strips() > limits::strips || spec.picture(spec.last).find('/') != std::string::npos ||
				spec.frame(spec.frames() - 1) > spec.last || (spec.strips_per_frame() - 1) * spec.strip_rows >= spec.height)
				fail("a job that cannot be was taken", input);
		});
	});
}

void address(const std::string& input) {
	static const Router router = [] {
		Router r;
		for (const char* path : {"/health", "/v1/jobs", "/v1/jobs/*", "/v1/jobs/*/frames/*", "/v1/leases/*/strip"})
			r.add("GET", path, {});
		return r;
	}();
	// Others do not come through the HTTP parser.
	if (std::any_of(input.begin(), input.end(), [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == 127; }))
		return;
	refused_or(input, [&] {
		Request request;
		request.method = "GET";
		const Route& route = router.find(request, input);
		const auto stars = std::count(route.pattern.begin(), route.pattern.end(), "*");
		if (static_cast<std::ptrdiff_t>(request.parts.size()) != stars)
			fail("an address has other parts than its route", input);
		for (const auto& part : request.parts)
			if (part.empty() || part.find('\0') != std::string::npos)
				fail("an address has an empty part", input);
	});
}

/// A request's headers, a line each; '@' stands for a cookie that opens, '#' for a token that does.
void door(const std::string& input) {
	static const std::string token(64, '5');
	static Door entrance({token});
	static const std::string cookie = [] {
		entrance.stands_at(7700, false);
		const std::string line = entrance.let_in();
		return line.substr(line.find('=') + 1, 64);
	}();
	Request request;
	request.method = "GET";
	std::istringstream lines(input);
	for (std::string line; std::getline(lines, line);) {
		std::string text;
		for (const char c : line)
			text += c == '@' ? cookie : c == '#' ? token : std::string(1, c);
		if (const size_t colon = text.find(": "); colon != std::string::npos)
			request.headers[text.substr(0, colon)] = text.substr(colon + 2);
	}
	bool in = false;
	refused_or(input, [&] {
		entrance.check(request);
		in = true;
	});
	if (in && input.find_first_of("@#") == std::string::npos && input.find(token) == std::string::npos)
		fail("let in without token or cookie", input);
	request.method = "POST";
	refused_or(input, [&] {
		entrance.check(request);
		if (!in)
			fail("a POST comes in where a GET does not", input);
		if (input.find('#') == std::string::npos && input.find(token) == std::string::npos && !Door::from_own_page(request))
			fail("a page of another origin comes in", input);
	});
}

void words(const std::string& input) {
	refused_or(
		input, [&] { read_word(input.substr(0, input.find('\0'))); }, true);
	put(place() / "x.ini", input);
	const auto back = [](const Setting& setting) {
		if (setting.first.size() >= 8 && same_key(setting.first.substr(setting.first.size() - 8), "_Command"))
			return; // goes to the line's end, quotes and all
		put(place() / "y.ini", ini_line(setting) + "\n");
		const auto again = read_ini("y.ini");
		if (again.size() != 1 || again[0] != setting)
			fail("an INI line is read back otherwise", ini_line(setting));
	};
	const auto read = [&] {
		for (const auto& setting : read_ini("x.ini"))
			refused_or(
				input, [&] { back(setting); }, true);
	};
	refused_or(input, read, true);
}

/// A PNG whose chunks have the right checksums: or nothing behind them would ever be seen.
std::string mended(std::string png) {
	for (size_t at = 8; at + 12 <= png.size();) {
		const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<unsigned char>(png[i])); };
		const size_t size = byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
		if (size > png.size() - at - 12)
			break;
		const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(png.data()) + at + 4, static_cast<uInt>(size + 4));
		for (size_t i = 0; i < 4; ++i)
			png[at + 8 + size + i] = static_cast<char>(sum >> (24 - 8 * i) & 255);
		at += size + 12;
	}
	return png;
}

/// A strip of rows 2 to 4 of a frame with 6 rows of 5 pixels.
void picture(std::string input, Format format, int bits) {
	JobSpec spec;
	spec.width = 5;
	spec.height = 6;
	spec.strip_rows = 3;
	spec.format = format;
	spec.bits = bits;
	const fs::path strip = place() / ("strip" + spec.suffix()), other = place() / ("other" + spec.suffix()),
				   whole = place() / "whole";
	put(strip, format == Format::png ? mended(std::move(input)) : input);
	refused_or(input, [&] { cut(format, strip, 0, 1, other); });
	bool good = false;
	refused_or(input, [&] { good = check_strip(spec, 3, 3, strip).size() == 64; });
	if (!good)
		return;
	refused_or(input, [&] {
		if (format == Format::png)
			fs::copy_file(strip, other, fs::copy_options::overwrite_existing);
		else
			spec.height = spec.strip_rows; // EXR strips know their place
		std::vector<fs::path> strips(format == Format::png ? 2 : 1, strip);
		stitch(spec, strips, whole);
		fs::remove(whole);
	});
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
	if (size == 0)
		return 0;
	const std::string input(reinterpret_cast<const char*>(data) + 1, size - 1);
	switch (data[0] % 8) {
	case 0:
		messages(input);
		break;
	case 1:
		address(input);
		break;
	case 2:
		words(input);
		break;
	case 3:
		picture(input, Format::png, 8);
		break;
	case 4:
		picture(input, Format::png, 16);
		break;
	case 5:
		picture(input, Format::exr, 16);
		break;
	case 6:
		picture(input, Format::exr, 32);
		break;
	case 7:
		door(input);
		break;
	}
	return 0;
}
