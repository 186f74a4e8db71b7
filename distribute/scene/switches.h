// SPDX-License-Identifier: AGPL-3.0-or-later
/// POV-Ray's command-line switches, as the INI keys they stand for.
#ifndef FARM_SWITCHES_H
#define FARM_SWITCHES_H

#include <string>
#include <utility>
#include <vector>

namespace farm {

using Setting = std::pair<std::string, std::string>; ///< an INI key as POV-Ray spells it, and its value

/// Takes a switch without its sign, as in "W640" or "FN16"; `on` is whether the sign was '+'. Throws Error if POV-Ray has no such
/// switch.
std::vector<Setting> settings_of_switch(const std::string& text, bool on);

} // namespace farm
#endif
