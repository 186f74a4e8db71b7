// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/stitch/png_filter.h"

#include <cstdlib>
#include <cstring>
#include <vector>

namespace farm::png {
namespace {

int paeth(int a, int b, int c) {
	const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
	return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// What a filter foretells for byte i of a row.
template <int number> int foretold(const Byte* row, const Byte* above, size_t i, size_t step) {
	const int a = i >= step ? row[i - step] : 0;
	if constexpr (number == 0)
		return 0;
	else if constexpr (number == 1)
		return a;
	else if constexpr (number == 2)
		return above[i];
	else if constexpr (number == 3)
		return (a + above[i]) / 2;
	else
		return paeth(a, above[i], i >= step ? above[i - step] : 0);
}

template <int number> void apply(const Byte* row, const Byte* above, size_t bytes, size_t step, Byte* out) {
	for (size_t i = 0; i < bytes; ++i)
		out[i] = static_cast<Byte>(row[i] - foretold<number>(row, above, i, step));
}

template <int number, size_t step> void undo(const Byte* filtered, const Byte* above, size_t bytes, Byte* row) {
	for (size_t i = 0; i < bytes; ++i)
		row[i] = static_cast<Byte>(filtered[i] + foretold<number>(row, above, i, step));
}

template <size_t step> bool undo(int number, const Byte* filtered, const Byte* above, size_t bytes, Byte* row) {
	switch (number) {
	case 0:
		std::memcpy(row, filtered, bytes);
		return true;
	case 1:
		undo<1, step>(filtered, above, bytes, row);
		return true;
	case 2:
		undo<2, step>(filtered, above, bytes, row);
		return true;
	case 3:
		undo<3, step>(filtered, above, bytes, row);
		return true;
	case 4:
		undo<4, step>(filtered, above, bytes, row);
		return true;
	default:
		return false;
	}
}

} // namespace

void filter(const Byte* row, const Byte* above, size_t bytes, size_t step, Byte* out) {
	using Function = void (*)(const Byte*, const Byte*, size_t, size_t, Byte*);
	static constexpr Function all[] = {apply<0>, apply<1>, apply<2>, apply<3>, apply<4>};
	std::vector<Byte> tried(bytes);
	std::int64_t least = -1;
	for (int number = 0; number < (above ? 5 : 2); ++number) {
		all[number](row, above, bytes, step, tried.data());
		std::int64_t sum = 0;
		for (const Byte b : tried)
			sum += b < 128 ? b : 256 - b;
		if (least >= 0 && sum >= least)
			continue;
		least = sum;
		out[0] = static_cast<Byte>(number);
		std::memcpy(out + 1, tried.data(), bytes);
	}
}

bool unfilter(int number, const Byte* filtered, const Byte* above, size_t bytes, size_t step, Byte* row) {
	switch (step) {
	case 1:
		return undo<1>(number, filtered, above, bytes, row);
	case 2:
		return undo<2>(number, filtered, above, bytes, row);
	case 3:
		return undo<3>(number, filtered, above, bytes, row);
	case 4:
		return undo<4>(number, filtered, above, bytes, row);
	case 6:
		return undo<6>(number, filtered, above, bytes, row);
	case 8:
		return undo<8>(number, filtered, above, bytes, row);
	default:
		return false;
	}
}

} // namespace farm::png
