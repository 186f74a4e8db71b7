// SPDX-License-Identifier: AGPL-3.0-or-later
/// Numerical stability at the extremes: a million rays where cameras, mirrors and rounding may put them.
#include "extremes.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

using namespace blackhole;
using namespace extremes;

class Extremes : public testing::TestWithParam<int> {};

TEST_P(Extremes, KeepEveryPromise) {
	const Kind kind = Kind(GetParam());
	std::mt19937_64 random(100 + kind);
	Path path;
	Figures figures;
	int failures = 0, tried = 0;
	for (; figures.rays < 100000 && tried < 1000000; tried++) {
		const Ray ray = generate(kind, random);
		if (!allowed(ray))
			continue;
		const std::string what = check(ray, tried % 16 == 0, path, figures);
		EXPECT_EQ(what, "") << ray.text();
		if (!what.empty() && ++failures >= 20)
			break;
	}
	figures.print(kind_names[kind]);
	EXPECT_GE(figures.rays, 100000);
}

INSTANTIATE_TEST_SUITE_P(Of, Extremes, testing::Range(0, int(kinds)), [](const testing::TestParamInfo<int>& i) {
	std::string name = kind_names[i.param];
	for (char& c : name)
		c = c == ' ' ? '_' : c;
	return name;
});
