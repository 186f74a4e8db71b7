// SPDX-License-Identifier: AGPL-3.0-or-later
/// Four numbers in single precision at a time. SSE is part of every x86-64; compilers do not find these instructions by
/// themselves.
#ifndef BLACKHOLE_FOUR_H
#define BLACKHOLE_FOUR_H

#include <cmath>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace blackhole {

typedef float Four __attribute__((vector_size(16)));

inline Four all(double x) {
	const float f = static_cast<float>(x);
	return Four{f, f, f, f};
}

// Where one is no number: b; and no number is greater than another.
#ifdef __SSE__
inline Four greater(Four a, Four b) { return _mm_max_ps(a, b); }
inline Four lesser(Four a, Four b) { return _mm_min_ps(a, b); }
inline Four root(Four a) { return _mm_sqrt_ps(a); }
inline int not_greater(Four a, Four b) { return _mm_movemask_ps(_mm_cmpngt_ps(a, b)); }
#else
inline Four greater(Four a, Four b) { return a > b ? a : b; }
inline Four lesser(Four a, Four b) { return a < b ? a : b; }
inline Four root(Four a) { return Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }
/// Bit i: whether number i of a is not greater than that of b.
inline int not_greater(Four a, Four b) {
	return !(a[0] > b[0]) | !(a[1] > b[1]) << 1 | !(a[2] > b[2]) << 2 | !(a[3] > b[3]) << 3;
}
#endif
inline Four absolute(Four a) { return greater(a, -a); }

/// Rows become columns.
inline void transpose(const Four* rows, Four& a, Four& b, Four& c, Four& d) {
	const Four ab0 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5),
			   ab1 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
	const Four cd0 = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7),
			   cd1 = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
	a = __builtin_shufflevector(ab0, ab1, 0, 1, 4, 5);
	b = __builtin_shufflevector(ab0, ab1, 2, 3, 6, 7);
	c = __builtin_shufflevector(cd0, cd1, 0, 1, 4, 5);
	d = __builtin_shufflevector(cd0, cd1, 2, 3, 6, 7);
}

} // namespace blackhole

#endif
