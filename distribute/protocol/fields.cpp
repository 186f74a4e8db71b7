// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/protocol/fields.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/protocol/messages.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace farm {

Fields::Fields(const json& object, std::string name) : source(object), what(std::move(name)) {
	if (!object.is_object())
		throw Error(what + ": a JSON object is needed");
}

const json* Fields::find(const char* key, bool needed) const {
	const auto found = source.find(key);
	if (found == source.end() || found->is_null()) {
		if (needed)
			throw Error(what + ": " + key + " is missing");
		return nullptr;
	}
	return &*found;
}

std::string Fields::text(const char* key, size_t least, size_t most, std::optional<std::string> otherwise) const {
	const json* value = find(key, !otherwise);
	if (!value)
		return *otherwise;
	if (!value->is_string())
		throw Error(what + ": " + key + " must be a string");
	const auto& s = value->get_ref<const std::string&>();
	if (s.size() < least || s.size() > most)
		throw Error(what + ": " + key + " must have from " + std::to_string(least) + " to " + std::to_string(most) + " bytes");
	return s;
}

std::string Fields::hash(const char* key) const {
	const std::string s = text(key, 0, 64);
	if (!is_sha256(s))
		throw Error(what + ": " + key + " must be 64 hexadecimal digits");
	return s;
}

std::int64_t Fields::integer(
	const char* key, std::int64_t least, std::int64_t most, std::optional<std::int64_t> otherwise) const {
	const json* value = find(key, !otherwise);
	if (!value)
		return *otherwise;
	const bool fits = value->is_number_integer() && !(value->is_number_unsigned() && value->get<std::uint64_t>() > INT64_MAX);
	const std::int64_t i = fits ? value->get<std::int64_t>() : 0;
	if (!fits || i < least || i > most)
		throw Error(what + ": " + key + " must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
	return i;
}

double Fields::real(const char* key, double least, double most, std::optional<double> otherwise) const {
	const json* value = find(key, !otherwise);
	if (!value)
		return *otherwise;
	const double d = value->is_number() ? value->get<double>() : std::nan("");
	if (!(d >= least && d <= most))
		throw Error(what + ": " + key + " must be a number from " + std::to_string(least) + " to " + std::to_string(most));
	return d;
}

bool Fields::boolean(const char* key, std::optional<bool> otherwise) const {
	const json* value = find(key, !otherwise);
	if (!value)
		return *otherwise;
	if (!value->is_boolean())
		throw Error(what + ": " + key + " must be true or false");
	return value->get<bool>();
}

const json& Fields::array(const char* key, std::int64_t most) const {
	const json* value = find(key, true);
	if (!value->is_array() || value->size() > static_cast<size_t>(most))
		throw Error(what + ": " + key + " must be a list of at most " + std::to_string(most));
	return *value;
}

const json& Fields::object(const char* key) const {
	const json* value = find(key, true);
	if (!value->is_object())
		throw Error(what + ": " + key + " must be an object");
	return *value;
}

std::string shown(const std::string& text) {
	std::string line = text.substr(0, 80);
	for (char& c : line)
		c = static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
	return line;
}

bool is_plain_name(const std::string& name) {
	return !name.empty() && name != "." && name != ".." && name.size() <= 255 &&
		   std::all_of(
			   name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) >= 32 && c != '/' && c != 127; });
}

bool is_inner_path(const std::string& path) {
	size_t from = 0;
	while (true) {
		const size_t slash = path.find('/', from);
		if (!is_plain_name(path.substr(from, slash - from)))
			return false;
		if (slash == std::string::npos)
			return true;
		from = slash + 1;
	}
}

bool is_ini_setting(const std::string& line) {
	const size_t equals = line.find('=');
	if (equals == std::string::npos || equals == 0 || equals + 1 == line.size())
		return false;
	const auto is_letter = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
	if (!std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(equals), is_letter))
		return false;
	if (std::any_of(line.begin(), line.end(), [](unsigned char c) { return (c < 32 && c != '\t') || c == 127; }))
		return false;
	const std::string value = line.substr(equals + 1);
	if (const char quote = value[0]; quote == '"' || quote == '\'')
		return value.find(quote, 1) == value.size() - 1;
	return value.find_first_of(" \t,;#\"'") == std::string::npos;
}

json parse_object(const std::string& text) {
	bool deep = false;
	json value = json::parse(
		text.begin(), text.end(),
		[&](int d, json::parse_event_t, json&) {
			deep = deep || d > 64;
			return !deep;
		},
		false);
	// The parser has checked UTF-8 as well.
	if (deep || value.is_discarded() || !value.is_object())
		throw Error("the body is not a JSON object");
	return value;
}

} // namespace farm
