// SPDX-License-Identifier: AGPL-3.0-or-later
/// As extremes_test.cpp, with a hundred million rays, or as many as the time allows; prints the figures for the documentation.
/// BLACKHOLE_RAYS: how many in all; BLACKHOLE_SECONDS: how long at most (1200); BLACKHOLE_SEED: which.
#include "extremes.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace extremes;

namespace {

double setting(const char* name, double otherwise) {
	const char* text = std::getenv(name);
	return text ? std::atof(text) : otherwise;
}

} // namespace

int main() {
	const double most = setting("BLACKHOLE_RAYS", 1e8), seconds = setting("BLACKHOLE_SECONDS", 1200);
	const auto start = std::chrono::steady_clock::now();
	const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
	std::mt19937_64 random(std::uint64_t(setting("BLACKHOLE_SEED", 1)));
	blackhole::Path path;
	Figures figures[kinds];
	long rays = 0, failures = 0;
	// A thousand of each kind in turn, so that all get their share of the time.
	while (double(rays) < most && passed() < seconds && failures < 100)
		for (int kind = 0; kind < kinds; kind++)
			for (int i = 0; i < 1000; i++) {
				const Ray ray = generate(Kind(kind), random);
				if (!allowed(ray))
					continue;
				rays++;
				const std::string what = check(ray, i % 16 == 0, path, figures[kind]);
				if (!what.empty() && ++failures <= 100)
					std::printf("FAILED %s: %s: %s\n", kind_names[kind], what.c_str(), ray.text().c_str());
			}
	for (int kind = 0; kind < kinds; kind++)
		figures[kind].print(kind_names[kind]);
	std::printf("[ extremes ] %ld rays in %.0f s, %ld failures\n", rays, passed(), failures);
	return failures == 0 && rays > 0 ? 0 : 1;
}
