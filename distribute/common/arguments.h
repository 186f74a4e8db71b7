// SPDX-License-Identifier: AGPL-3.0-or-later
/// The words of a command line.
#ifndef FARM_ARGUMENTS_H
#define FARM_ARGUMENTS_H

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace farm {

/// One option: `--name VALUE`, `--name=VALUE`, or `--name` alone where `value` is empty.
struct Option {
	std::string name;  ///< with its dashes
	std::string value; ///< what --help calls the value; empty for a switch
	std::string help;
	std::string otherwise; ///< the value if the option is not given
};

/// Parses a command line. Words that are no options of ours stay in order; those are somebody else's business.
class Arguments {
public:
	/// Throws Error for a value that is missing or for an unknown word that starts with `--`. `--help` is always known.
	Arguments(const std::vector<std::string>& words, const std::vector<Option>& options);

	bool has(const std::string& name) const { return values.count(name) > 0; }
	const std::string& get(const std::string& name) const;
	/// Every value of an option that may be given several times.
	std::vector<std::string> all(const std::string& name) const;
	/// As a whole number within [least, most]; throws Error, naming the option.
	long number(const std::string& name, long least, long most) const;
	/// Likewise, with decimals.
	double real(const std::string& name, double least, double most) const;
	std::vector<std::string> rest;

private:
	std::map<std::string, std::string> values, defaults;
	std::vector<std::pair<std::string, std::string>> given;
};

std::vector<Option> operator+(std::vector<Option> a, const std::vector<Option>& b);

/// Thrown by help_if_asked when it has printed the usage and the options, for run_program to end well.
struct HelpGiven {};
void help_if_asked(const Arguments& arguments, const std::string& usage, const std::vector<Option>& options);
/// Throws Error for a word that is no option.
void no_other_words(const Arguments& arguments);

/// What was given or, where that is empty, the variable of the environment.
std::string or_environment(const std::string& given, const char* variable);

/// --slots or, if it is not given, one a core.
int slots_from(const Arguments& arguments);

/// A main's body, and the exit code: what `run` returns, or 1 after one line for what it throws. A daemon's lines have the time.
int run_program(const std::string& name, bool daemon, const std::function<int()>& run);

/// A whole number within [least, most]; throws Error with `what` as the value's name.
long whole_number(const std::string& text, const std::string& what, long least, long most);
/// Likewise, with decimals.
double real_number(const std::string& text, const std::string& what, double least, double most);

} // namespace farm
#endif
