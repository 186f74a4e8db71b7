// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/protocol/messages.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/protocol/fields.h"

#include <set>

namespace farm {

std::string Bundle::id() const { return sha256(json(*this).dump()); }

std::string JobSpec::picture(int frame) const {
	std::string number = animation ? std::to_string(frame) : "";
	if (animation && number.size() < static_cast<size_t>(digits))
		number.insert(0, static_cast<size_t>(digits) - number.size(), '0');
	return name + number + suffix();
}

namespace {

void in(const char* what, std::int64_t value, std::int64_t least, std::int64_t most) {
	if (value < least || value > most)
		throw Error(std::string(what) + " is " + std::to_string(value) + "; it must be from " + std::to_string(least) + " to " +
					std::to_string(most));
}

} // namespace

void JobSpec::check_size() const {
	in("width", width, 1, limits::pixels);
	in("height", height, 1, limits::pixels);
	if (const std::int64_t all = std::int64_t(width) * height; all > limits::area)
		throw Error("the size is " + std::to_string(width) + "x" + std::to_string(height) + ", " + std::to_string(all) +
					" pixels; a frame may have " + std::to_string(limits::area));
}

void JobSpec::check() const {
	if (!is_plain_name(name) || name.size() > 200)
		throw Error("name is '" + shown(name) + "'; it must be a file's name without its folder");
	if (!is_sha256(bundle))
		throw Error("bundle is '" + shown(bundle) + "'; it must be 64 hexadecimal digits");
	for (const auto& line : options)
		if (line.size() > 4096 || !is_ini_setting(line))
			throw Error("options has '" + shown(line) + "'; each must be one line KEY=VALUE, the value quoted if it has blanks");
	check_size();
	in("first", first, 0, 1 << 30);
	in("last", last, first, 1 << 30);
	in("step", step, 1, 1 << 30);
	in("frames", std::int64_t(last - first) / step + 1, 1, animation ? limits::frames : 1);
	in("digits", digits, 0, 10);
	in("strip_rows", strip_rows, 1, limits::pixels);
	in("strips", std::int64_t(frames()) * strips_per_frame(), 1, limits::strips);
	in("priority", priority, -100, 100);
	if (!(film_rate >= 0 && film_rate <= 1000))
		throw Error("film_rate must be from 0 to 1000");
	const bool good = format == Format::png ? bits == 8 || bits == 16 : bits == 16 || bits == 32;
	if (!good)
		throw Error("bits is " + std::to_string(bits) + "; it must be " + (format == Format::png ? "8 or 16" : "16 or 32"));
}

void to_json(json& j, const BundleFile& v) { j = json{{"name", v.name}, {"sha256", v.sha256}, {"bytes", v.bytes}}; }

void from_json(const json& j, BundleFile& v) {
	const Fields f(j, "file");
	v.name = f.text("name", 1, 1000);
	v.sha256 = f.hash("sha256");
	v.bytes = f.integer("bytes", 0, limits::file_bytes);
	if (!is_inner_path(v.name))
		throw Error("file name '" + shown(v.name) + "' must be a relative path in UTF-8 without '..'");
}

void to_json(json& j, const Bundle& v) { j = json{{"folder", v.folder}, {"files", v.files}}; }

void from_json(const json& j, Bundle& v) {
	const Fields f(j, "bundle");
	v.folder = f.text("folder", 0, 1000);
	if (!v.folder.empty() && !is_inner_path(v.folder))
		throw Error("bundle folder '" + shown(v.folder) + "' must be a relative path without '..'");
	const json& files = f.array("files", limits::files);
	v.files.clear();
	std::int64_t bytes = 0;
	for (const auto& file : files) {
		v.files.push_back(file.get<BundleFile>());
		bytes += v.files.back().bytes;
	}
	if (bytes > limits::bundle_bytes)
		throw Error(
			"the bundle has " + std::to_string(bytes) + " bytes; " + std::to_string(limits::bundle_bytes) + " are allowed");
	// What is a folder to one file must not be a file itself.
	std::set<std::string> names, folders = {v.folder};
	for (const auto& file : v.files) {
		if (!names.insert(file.name).second)
			throw Error("the bundle has '" + shown(file.name) + "' twice");
		for (size_t slash = file.name.find('/'); slash != std::string::npos; slash = file.name.find('/', slash + 1))
			folders.insert(file.name.substr(0, slash));
	}
	for (size_t slash = v.folder.find('/'); slash != std::string::npos; slash = v.folder.find('/', slash + 1))
		folders.insert(v.folder.substr(0, slash));
	for (const auto& folder : folders)
		if (names.count(folder))
			throw Error("the bundle has '" + shown(folder) + "' as a file and as a folder");
}

void to_json(json& j, const JobSpec& v) {
	j = json{{"name", v.name}, {"bundle", v.bundle}, {"options", v.options}, {"width", v.width}, {"height", v.height},
		{"animation", v.animation}, {"first", v.first}, {"last", v.last}, {"step", v.step}, {"digits", v.digits},
		{"format", v.format == Format::png ? "png" : "exr"}, {"bits", v.bits}, {"strip_rows", v.strip_rows},
		{"whole_because", v.whole_because}, {"priority", v.priority}, {"film_rate", v.film_rate}, {"client_key", v.client_key}};
}

void from_json(const json& j, JobSpec& v) {
	const Fields f(j, "job");
	v.name = f.text("name", 1, 200);
	v.bundle = f.hash("bundle");
	v.options.clear();
	for (const auto& line : f.array("options", 1000)) {
		if (!line.is_string())
			throw Error("job: options must be strings");
		v.options.push_back(line.get<std::string>());
	}
	const auto number = [&](const char* key, std::int64_t most) { return static_cast<int>(f.integer(key, 0, most)); };
	v.width = number("width", limits::pixels);
	v.height = number("height", limits::pixels);
	v.animation = f.boolean("animation");
	v.first = number("first", 1 << 30);
	v.last = number("last", 1 << 30);
	v.step = number("step", 1 << 30);
	v.digits = number("digits", 10);
	const std::string format = f.text("format", 3, 3);
	if (format != "png" && format != "exr")
		throw Error("job: format is '" + shown(format) + "'; it must be png or exr");
	v.format = format == "png" ? Format::png : Format::exr;
	v.bits = number("bits", 32);
	v.strip_rows = number("strip_rows", limits::pixels);
	v.whole_because = f.text("whole_because", 0, 1000, "");
	v.priority = static_cast<int>(f.integer("priority", -100, 100, 0));
	v.film_rate = f.real("film_rate", 0, 1000, 0);
	v.client_key = f.text("client_key", 0, 200, "");
	v.check();
}

void to_json(json& j, const Hello& v) {
	j = json{{"id", v.id}, {"name", v.name}, {"slots", v.slots}, {"povray", v.povray}, {"probe", v.probe}};
}

void from_json(const json& j, Hello& v) {
	const Fields f(j, "worker");
	v.id = f.text("id", 8, 64);
	v.name = f.text("name", 1, 200);
	v.slots = static_cast<int>(f.integer("slots", 1, 4096));
	v.povray = f.text("povray", 0, 1000, "");
	v.probe = f.text("probe", 0, 64, "");
}

void to_json(json& j, const Task& v) {
	j = json{{"lease", v.lease}, {"job", v.job}, {"frame", v.frame}, {"row", v.row}, {"rows", v.rows}, {"spec", v.spec}};
}

void from_json(const json& j, Task& v) {
	const Fields f(j, "task");
	v.lease = f.integer("lease", 1, INT64_MAX);
	v.job = f.integer("job", 1, INT64_MAX);
	v.frame = static_cast<int>(f.integer("frame", 0, 1 << 30));
	v.row = static_cast<int>(f.integer("row", 0, limits::pixels));
	v.rows = static_cast<int>(f.integer("rows", 1, limits::pixels));
	v.spec = f.object("spec").get<JobSpec>();
}

void to_json(json& j, const Failure& v) { j = json{{"line", v.line}, {"log", v.log}, {"limited", v.limited}}; }

void from_json(const json& j, Failure& v) {
	const Fields f(j, "failure");
	v.line = f.text("line", 0, 2000);
	v.log = f.text("log", 0, limits::log_bytes, "");
	v.limited = f.boolean("limited", false);
}

} // namespace farm
