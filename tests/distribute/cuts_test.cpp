// SPDX-License-Identifier: AGPL-3.0-or-later
// Strips are cut by a formula; here farms are simulated strip by strip, to see what other cuts would have given.
#include "distribute/scene/cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <vector>

namespace {

struct Case {
	double frame, parse, light;
	int frames, slots, height;
};

int cut(const Case& c, int count = 0) {
	farm::JobSpec spec;
	spec.width = c.height * 16 / 9;
	spec.height = c.height;
	spec.animation = true;
	spec.first = 1;
	spec.last = c.frames;
	farm::Gathered files;
	files.frame_seconds = c.frame;
	files.parse_seconds = c.parse;
	files.light_seconds = c.light;
	return farm::strip_rows(spec, files, count, c.slots);
}

/// Seconds until the last of the slots is done, each taking the next strip when it has none; the middle of a frame, where the
/// hole is, costs five times its edges.
double simulated(const Case& c, int rows) {
	std::vector<double> strips;
	const auto cost_to = [&](double row) { // the integral of 1 + 4 sin^2(pi y)
		const double y = row / c.height;
		return 3 * y - std::sin(2 * M_PI * y) / M_PI;
	};
	for (int row = 0; row < c.height; row += rows) {
		const int end = std::min(c.height, row + rows);
		const double whole = rows < c.height ? 0.13e-6 * c.height * c.height * 16 / 9 : 0;
		strips.push_back(c.frame * (cost_to(end) - cost_to(row)) / 3 + c.parse + c.light + 0.07 + whole);
	}
	std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
	for (int slot = 0; slot < c.slots; ++slot)
		free_at.push(0);
	double end = 0;
	for (int frame = 0; frame < c.frames; ++frame)
		for (const double strip : strips) {
			const double done = free_at.top() + strip;
			free_at.pop();
			free_at.push(done);
			end = std::max(end, done);
		}
	return end;
}

TEST(Cuts, AreNearlyTheBestOnes) {
	for (const double frame : {0.2, 3.0, 20.0, 100.0})
		for (const double parse : {0.02, 0.5})
			for (const int frames : {1, 24, 500})
				for (const int slots : {1, 2, 16, 64}) {
					const Case c{frame, parse, 0, frames, slots, 1080};
					double best = 1e30;
					for (int rows = 32; rows <= 1088; rows += 32)
						best = std::min(best, simulated(c, std::min(rows, c.height)));
					// A strip in the middle costs up to 5/3 of the mean, of which the formula knows nothing.
					EXPECT_LT(simulated(c, cut(c)), 5.0 / 3 * best) << frame << " s, parse " << parse << " s, " << frames
																	<< " frames, " << slots << " slots: " << cut(c) << " rows";
				}
}

TEST(Cuts, AreSaneAtTheEdges) {
	// An hour a frame, ten seconds of parsing: that is a twentieth of a strip at most, unless slots would have nothing to do; and
	// no strip takes ten minutes.
	for (const int slots : {1, 2, 100}) {
		const double strip = 3600.0 * cut({3600, 10, 0, 1, slots, 1080}) / 1080;
		EXPECT_GE(strip, slots < 10 ? 190 : 60);
		EXPECT_LE(strip, 600);
	}
	EXPECT_EQ(cut({0.1, 0.05, 0, 10, 8, 1080}), 1080);
	EXPECT_EQ(cut({1e5, 0.01, 0, 1, 8, 1080}), 32);
	EXPECT_EQ(cut({1, 0.01, 0, 1, 8, 1}), 1);
	EXPECT_EQ(cut({0, 0, 0, 1, 8, 1080}), 1080);
	// A poster of 16384 rows: its strips are written and read as a whole one.
	EXPECT_GE(cut({600, 0.1, 0, 1, 4, 16384}), 16384 / 10);
	// As asked for.
	EXPECT_EQ(cut({1, 1, 0, 1, 8, 1080}, 1), 1080);
	EXPECT_EQ(cut({1, 1, 0, 1, 8, 1080}, 3), 384);
	EXPECT_EQ(cut({1, 1, 0, 1, 8, 1080}, 1080), 1);
	// Radiosity's pretrace comes with each strip: fewer of them.
	EXPECT_GT(cut({100, 0.1, 10, 5, 4, 1080}), cut({100, 0.1, 0, 5, 4, 1080}));
}

} // namespace
