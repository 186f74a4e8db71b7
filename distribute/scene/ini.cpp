// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/scene/ini.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"

#include <algorithm>
#include <cctype>

namespace farm {
namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }
bool blank(char c) { return c == ' ' || c == '\t'; }
bool word_char(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::string trimmed(std::string s) {
	while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back())))
		s.pop_back();
	size_t from = 0;
	while (from < s.size() && std::isspace(static_cast<unsigned char>(s[from])))
		++from;
	return s.substr(from);
}

bool ends_with(const std::string& s, const char* suffix) {
	const std::string t = suffix;
	return s.size() >= t.size() && std::equal(t.begin(), t.end(), s.end() - static_cast<std::ptrdiff_t>(t.size()),
									   [](char a, char b) { return lower(a) == lower(b); });
}

/// The rest of one line, word by word.
class Line {
public:
	explicit Line(std::string t) : text(std::move(t)) {}
	bool end() {
		while (at < text.size() && blank(text[at]))
			++at;
		return at >= text.size() || text[at] == ';' || text[at] == '#';
	}
	char peek() const { return at < text.size() ? text[at] : 0; }
	bool skip(char c) {
		if (end() || text[at] != c)
			return false;
		++at;
		return true;
	}
	std::string key() {
		const size_t from = at;
		while (at < text.size() && word_char(text[at]))
			++at;
		return text.substr(from, at - from);
	}
	/// A quoted string, or what goes to the next space; a value that is no list and no switches may have spaces in it, as a path.
	std::string value(bool spaces) {
		if (peek() == '"' || peek() == '\'') {
			const char quote = text[at++];
			const size_t to = std::min(text.find(quote, at), text.size());
			const std::string inner = text.substr(at, to - at);
			at = std::min(to + 1, text.size());
			return inner;
		}
		const size_t from = at;
		while (at < text.size() && !blank(text[at]) && std::string(",;#\"'").find(text[at]) == std::string::npos)
			++at;
		if (spaces && at < text.size() && blank(text[at])) {
			const size_t word_end = at;
			const bool over = end() || peek() == ',' ||
							  ((peek() == '+' || peek() == '-') && std::isalpha(static_cast<unsigned char>(text[at + 1])));
			if (!over) {
				at = std::min(text.find_first_of(";#", at), text.size());
				return trimmed(text.substr(from, at - from));
			}
			at = word_end;
		}
		return text.substr(from, at - from);
	}
	std::string rest() {
		const std::string r = text.substr(std::min(at, text.size()));
		at = text.size();
		return r;
	}

private:
	std::string text;
	size_t at = 0;
};

class Reader {
public:
	explicit Reader(int d) : depth(d) {}
	std::vector<Setting> settings;

	void file(const std::string& specification, const fs::path& beside) {
		if (depth > 16)
			throw Error("INI files include each other: " + specification);
		std::string name = specification, section;
		if (const size_t open = name.find('['); open != std::string::npos) {
			const size_t close = name.find(']', open);
			if (close == std::string::npos)
				throw Error("'" + specification + "' has a '[' without a ']'");
			section = name.substr(open + 1, close - open - 1);
			name.resize(open);
		}
		fs::path path = name;
		if (path.is_relative() && !beside.empty() && fs::exists(beside / path))
			path = beside / path;
		const std::string text = read_file(path);
		bool active = true, section_found = section.empty();
		size_t from = 0;
		for (int number = 1; from < text.size(); ++number) {
			size_t to = text.find_first_of("\n\r", from);
			if (to == std::string::npos)
				to = text.size();
			const std::string line = trimmed(text.substr(from, to - from));
			from = to + (text.compare(to, 2, "\r\n") == 0 ? 2 : 1);
			if (!line.empty() && line[0] == '[') {
				const std::string here = line.substr(1, line.find(']') - 1);
				active = !section.empty() && same_key(here, section);
				section_found = section_found || active;
			} else if (active) {
				try {
					one_line(Line(line), path.parent_path());
				} catch (const Error& e) {
					throw Error(path.string() + ":" + std::to_string(number) + ": " + e.what());
				}
			}
		}
		if (!section_found)
			throw Error(path.string() + " has no section [" + section + "]");
	}

	void one_line(Line line, const fs::path& folder) {
		while (!line.end()) {
			const char c = line.peek();
			if (c == '+' || c == '-') {
				line.skip(c);
				std::string text = line.value(false);
				if (line.peek() == '"' || line.peek() == '\'')
					text += line.value(false);
				append(settings_of_switch(text, c == '+'), folder);
				continue;
			}
			Line ahead = line;
			const std::string key = ahead.key();
			if (!key.empty() && ahead.skip('=')) {
				ahead.end();
				if (ends_with(key, "_Command")) {
					append({{key, trimmed(ahead.rest())}}, folder);
					return;
				}
				do {
					ahead.end();
					append({{key, ahead.value(true)}}, folder);
				} while (ahead.skip(','));
				return; // POV-Ray reads one key a line
			}
			append({{"", line.value(false)}}, folder);
		}
	}

	/// A word without a key is a scene, a folder or an INI file.
	void append(const std::vector<Setting>& found, const fs::path& folder) {
		for (auto [key, value] : found) {
			if (key.empty() && ends_with(value, ".pov")) {
				key = "Input_File_Name";
			} else if (key.empty() && !value.empty() && value.back() == '/') {
				key = "Library_Path";
			} else if (key.empty() && value.empty()) {
				throw Error("a word is missing");
			} else if (key.empty() || same_key(key, "Include_Ini")) {
				Reader inner(depth + 1);
				inner.file(value, folder);
				settings.insert(settings.end(), inner.settings.begin(), inner.settings.end());
				continue;
			}
			settings.emplace_back(key, value);
		}
	}

private:
	int depth;
};

} // namespace

std::vector<Setting> read_ini(const std::string& file) {
	Reader reader(0);
	reader.file(file, "");
	return reader.settings;
}

std::vector<Setting> read_word(const std::string& word) {
	Reader reader(0);
	// The shell has taken the quotes away, so what follows is one value, spaces and all.
	Line line(word);
	const char c = line.peek();
	if ((c == '+' || c == '-') && word.size() > 1) {
		std::string text = word.substr(1);
		text.erase(std::remove(text.begin(), text.end(), '"'), text.end());
		reader.append(settings_of_switch(text, c == '+'), "");
		return reader.settings;
	}
	const std::string key = line.key();
	if (!key.empty() && line.skip('=')) {
		std::string value = line.rest();
		if (value.size() >= 2 && (value[0] == '"' || value[0] == '\'') && value.back() == value[0])
			value = value.substr(1, value.size() - 2);
		reader.append({{key, value}}, "");
	} else {
		reader.append({{"", word}}, "");
	}
	return reader.settings;
}

std::string ini_line(const Setting& setting) {
	const auto& [key, value] = setting;
	if (std::any_of(value.begin(), value.end(), [](char c) { return c != '\t' && static_cast<unsigned char>(c) < ' '; }))
		throw Error(key + " has a control character in its value");
	if (!value.empty() && value.find_first_of(" \t,;#\"'") == std::string::npos)
		return key + "=" + value;
	const char quote = value.find('"') == std::string::npos ? '"' : '\'';
	if (value.find(quote) != std::string::npos)
		throw Error(key + " has both kinds of quotes in its value, which POV-Ray's INI files cannot say");
	return key + "=" + quote + value + quote;
}

bool same_key(const std::string& a, const std::string& b) {
	return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

bool is_on(const std::string& value) {
	for (const std::string word : {"on", "true", "yes", "1"})
		if (!value.empty() &&
			std::equal(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(std::min(value.size(), word.size())),
				word.begin(), [](char x, char y) { return lower(x) == y; }))
			return true;
	return false;
}

} // namespace farm
