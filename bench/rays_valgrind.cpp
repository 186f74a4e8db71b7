// SPDX-License-Identifier: AGPL-3.0-or-later
/// Preloaded so that GYOTO starts under Valgrind, whose long double is a double: there Boost's largest long double, which
/// libgyoto makes as it is loaded for some of its metrics, is infinite, and an assertion ends the program.
#include <boost/multiprecision/cpp_dec_float.hpp>

#include <cfloat>

namespace boost::multiprecision::backends {

template <> const cpp_dec_float<100>& cpp_dec_float<100>::long_double_max() {
	static const cpp_dec_float<100> value(DBL_MAX);
	return value;
}

template <> const cpp_dec_float<100>& cpp_dec_float<100>::long_double_min() {
	static const cpp_dec_float<100> value(DBL_MIN);
	return value;
}

} // namespace boost::multiprecision::backends
