// SPDX-License-Identifier: AGPL-3.0-or-later
/// The words of a command line.
#ifndef FARM_ARGUMENTS_H
#define FARM_ARGUMENTS_H

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
	/// Throws Error for a value that is missing or for an unknown word that starts with `--`.
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

/// The options as lines for --help.
std::string help_lines(const std::vector<Option>& options);

/// A whole number within [least, most]; throws Error with `what` as the value's name.
long whole_number(const std::string& text, const std::string& what, long least, long most);

} // namespace farm
#endif
