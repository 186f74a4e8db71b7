// SPDX-License-Identifier: AGPL-3.0-or-later
/// PNG's filters (ISO/IEC 15948, chapter 9).
#ifndef FARM_PNG_FILTER_H
#define FARM_PNG_FILTER_H

#include <cstddef>
#include <cstdint>

namespace farm::png {

using Byte = std::uint8_t;

/// Adds to `out`, of `bytes` + 1 bytes, the filter's number and the filtered row, by the filter that leaves the smallest values.
/// `above` is the row above; null: filters that need none.
void filter(const Byte* row, const Byte* above, size_t bytes, size_t step, Byte* out);
/// Undoes it; `above` of zeros for the first row. False for a filter that there is not.
bool unfilter(int number, const Byte* filtered, const Byte* above, size_t bytes, size_t step, Byte* row);

} // namespace farm::png
#endif
