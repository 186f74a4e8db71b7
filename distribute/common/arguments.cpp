// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/arguments.h"

#include "distribute/common/error.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace farm {
namespace {
const std::vector<Option> help_option = {{"--help", "", "this", ""}};
} // namespace

Arguments::Arguments(const std::vector<std::string>& words, const std::vector<Option>& own) {
	const std::vector<Option> options = own + help_option;
	for (const auto& option : options)
		defaults[option.name] = option.otherwise;
	for (size_t i = 0; i < words.size(); ++i) {
		const std::string& word = words[i];
		if (word.rfind("--", 0) != 0) {
			rest.push_back(word);
			continue;
		}
		const size_t equals = word.find('=');
		const std::string name = word.substr(0, equals);
		const auto option = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == name; });
		if (option == options.end())
			throw Error("there is no option " + name + "; --help lists them");
		if (option->value.empty()) {
			if (equals != std::string::npos)
				throw Error(name + " takes no value");
			values[name] = "";
		} else if (equals != std::string::npos) {
			values[name] = word.substr(equals + 1);
		} else if (i + 1 < words.size()) {
			values[name] = words[++i];
		} else {
			throw Error(name + " needs a value: " + option->value);
		}
		given.emplace_back(name, values[name]);
	}
}

const std::string& Arguments::get(const std::string& name) const {
	const auto found = values.find(name);
	return found != values.end() ? found->second : defaults.at(name);
}

std::vector<std::string> Arguments::all(const std::string& name) const {
	std::vector<std::string> found;
	for (const auto& [n, value] : given)
		if (n == name)
			found.push_back(value);
	return found;
}

long Arguments::number(const std::string& name, long least, long most) const {
	return whole_number(get(name), name, least, most);
}

double Arguments::real(const std::string& name, double least, double most) const {
	return real_number(get(name), name, least, most);
}

double real_number(const std::string& text, const std::string& what, double least, double most) {
	double value = 0;
	const char* end = text.data() + text.size();
	const auto [at, error] = std::from_chars(text.data(), end, value);
	if (error != std::errc() || at != end || !(value >= least && value <= most)) {
		std::ostringstream range;
		range << least << " to " << most;
		throw Error(what + " is '" + text + "'; it must be a number from " + range.str());
	}
	return value;
}

long whole_number(const std::string& text, const std::string& what, long least, long most) {
	long value = 0;
	const char* end = text.data() + text.size();
	const auto [at, error] = std::from_chars(text.data(), end, value);
	if (error != std::errc() || at != end || value < least || value > most)
		throw Error(
			what + " is '" + text + "'; it must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
	return value;
}

std::vector<Option> operator+(std::vector<Option> a, const std::vector<Option>& b) {
	a.insert(a.end(), b.begin(), b.end());
	return a;
}

void help_if_asked(const Arguments& arguments, const std::string& usage, const std::vector<Option>& options) {
	if (!arguments.has("--help"))
		return;
	std::printf("%s\n", usage.c_str());
	for (const auto& option : options + help_option) {
		std::string line = "  " + option.name + (option.value.empty() ? "" : " " + option.value);
		line.resize(std::max<size_t>(line.size() + 2, 28), ' ');
		line += option.help + (option.otherwise.empty() ? "" : " (default " + option.otherwise + ")");
		std::printf("%s\n", line.c_str());
	}
	throw HelpGiven();
}

void no_other_words(const Arguments& arguments) {
	if (!arguments.rest.empty())
		throw Error("what is '" + arguments.rest[0] + "'? --help lists the options");
}

std::string or_environment(const std::string& given, const char* variable) {
	const char* value = std::getenv(variable);
	return given.empty() && value ? value : given;
}

int slots_from(const Arguments& arguments) {
	if (!arguments.has("--slots"))
		return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
	return static_cast<int>(arguments.number("--slots", 1, 1024));
}

int run_program(const std::string& name, bool daemon, const std::function<int()>& run) {
	name_program(name, daemon);
	try {
		return run();
	} catch (const HelpGiven&) {
		return 0;
	} catch (const std::exception& e) {
		name_program(name, false);
		say(e.what());
		return 1;
	}
}

} // namespace farm
