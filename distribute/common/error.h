// SPDX-License-Identifier: AGPL-3.0-or-later
/// What goes wrong in the farm, and how a program says so.
#ifndef FARM_ERROR_H
#define FARM_ERROR_H

#include <stdexcept>
#include <string>

namespace farm {

/// Something the user can set right: one line that names the file or the value and what would be right.
struct Error : std::runtime_error {
	explicit Error(const std::string& what, int errno_value = 0) : std::runtime_error(what), number(errno_value) {}
	/// Whether a disk had no room for it: to be tried again when there is.
	bool disk_full() const;
	int number; ///< errno where the system said no; else 0
};

/// What was going on was given up because somebody said so: a signal, mostly.
struct Stopped : Error {
	Stopped() : Error("stopped") {}
};

/// Unix's word for errno, with what was being done: "cannot write x: No space left on device".
Error system_error(const std::string& what);

/// To stderr, one line, with the program's name in front and the time if the program is a daemon.
void say(const std::string& line);

/// The text without what steers a terminal (what names a file, a worker or a scene may have anything in it): spaces instead.
/// `lines`: ends of lines and tabs stay.
std::string for_terminal(std::string text, bool lines = false);
void name_program(const std::string& name, bool timestamps);

} // namespace farm
#endif
