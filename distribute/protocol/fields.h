// SPDX-License-Identifier: AGPL-3.0-or-later
/// Reading a JSON object field by field, each checked.
#ifndef FARM_FIELDS_H
#define FARM_FIELDS_H

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace farm {

/// A view of one object. Everything throws Error with "WHAT: FIELD ..." if the field is missing (and has no default), of another
/// type or out of range. Lengths are in bytes of UTF-8.
class Fields {
public:
	Fields(const nlohmann::json& object, std::string what);

	std::string text(const char* key, size_t least, size_t most, std::optional<std::string> otherwise = {}) const;
	std::string hash(const char* key) const;
	std::int64_t integer(
		const char* key, std::int64_t least, std::int64_t most, std::optional<std::int64_t> otherwise = {}) const;
	double real(const char* key, double least, double most, std::optional<double> otherwise = {}) const;
	bool boolean(const char* key, std::optional<bool> otherwise = {}) const;
	const nlohmann::json& array(const char* key, std::int64_t most) const;
	const nlohmann::json& object(const char* key) const;

private:
	const nlohmann::json* find(const char* key, bool needed) const;
	const nlohmann::json& source;
	std::string what;
};

/// A stranger's text as part of one line: at most 80 bytes, without control characters.
std::string shown(const std::string& text);

/// A file's name: not empty, no slash, no control character, neither "." nor "..".
bool is_plain_name(const std::string& name);
/// A relative path of such names that stays inside.
bool is_inner_path(const std::string& path);
/// One line of an INI file that POV-Ray reads as one key and its value, whatever stands before and after: no section, no switch,
/// no comment, no quote left open, no second word.
bool is_ini_setting(const std::string& line);

} // namespace farm
#endif
