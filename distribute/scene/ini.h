// SPDX-License-Identifier: AGPL-3.0-or-later
/// Reads INI files and command lines as POV-Ray does, into INI keys and values in the order in which they take effect.
#ifndef FARM_INI_H
#define FARM_INI_H

#include "distribute/scene/switches.h"

#include <filesystem>

namespace farm {

/// `file` may name a section, as in "film.ini[Preview]": what stands before the first section, and in the one named. Files that
/// it includes are read in place, relative to it or else to the folder one is in. Input_File_Name and Library_Path come out as
/// they stand. Throws Error naming file and line.
std::vector<Setting> read_ini(const std::string& file);

/// A word of POV-Ray's command line: a switch, "Key=value", a scene, an INI file, or a folder (ending in a slash) to look in.
std::vector<Setting> read_word(const std::string& word);

/// The same as an INI line that read_ini and POV-Ray read back as it was.
std::string ini_line(const Setting& setting);

/// Compares keys as POV-Ray does, without regard to case.
bool same_key(const std::string& a, const std::string& b);
/// POV-Ray's truth: on, true, yes, 1 (each may be cut short); anything else is false.
bool is_on(const std::string& value);

} // namespace farm
#endif
