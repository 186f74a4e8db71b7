// SPDX-License-Identifier: AGPL-3.0-or-later
/// Whether two machines' povray make the same pixels.
#ifndef FARM_PROBE_H
#define FARM_PROBE_H

#include "distribute/sandbox/sandbox.h"

#include <filesystem>
#include <string>

namespace farm {

/// The SHA-256 of a small picture's pixels: a black hole, noise, reflections, chance, and much of the mathematics library. Throws
/// Error if povray cannot render it.
std::string probe(const std::filesystem::path& povray, const Sandbox& sandbox);

} // namespace farm
#endif
