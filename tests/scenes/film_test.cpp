// SPDX-License-Identifier: AGPL-3.0-or-later
/// No pops: a film of 120 frames moves as the exact one does, past the ends of chords and past the shells where chords are
/// tested.
///
/// Red and green are a place's x and y, on objects and of the sky's directions; blue is which object it is. A pop is a change of
/// the film's error from one frame to the next: errors are of the size of the tolerance, and smooth.
#include "povray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace {

constexpr int frames = 120, width = 64, height = 48, objects = 14;
constexpr double range = 14; // of the objects' coordinates: a step of 16 bits is 4e-4

// A flight inward and round, through the shell of the outer objects (7.2 to 8.8), between two of them.
const char* const scene = R"(
#macro Places(R, Id) texture { pigment { average pigment_map {
	[1 function { 0.5 + 0.5 * x / R } color_map { [0 rgb <0, 0, Id / 16>] [1 rgb <3, 0, Id / 16>] }]
	[1 function { 0.5 + 0.5 * y / R } color_map { [0 rgb <0, 0, Id / 16>] [1 rgb <0, 3, Id / 16>] }]
	[1 rgb <0, 0, Id / 16>]
} } finish { emission 1 ambient 0 diffuse 0 } } #end
#declare A = 0.6 * clock;
camera { location <sin(A), 0.25 + 0.1 * clock, -cos(A)> * (11 - 4.5 * clock) look_at <0, 0.2, 0> angle 62 }
#for (I, 0, 6)
	sphere { 0, 0.9 translate <4 * cos(I * 0.9 + 0.3), 1.5 * sin(2 * I), 4 * sin(I * 0.9 + 0.3)> Places(14, I + 1) }
	sphere { 0, 0.8 translate <8 * cos(I * 0.9), sin(3 * I + 1), 8 * sin(I * 0.9)> Places(14, I + 8) }
#end
sky_sphere { pigment { average pigment_map {
	[1 function { 0.5 + 0.5 * x } color_map { [0 rgb <0, 0, 0.94>] [1 rgb <3, 0, 0.94>] }]
	[1 function { 0.5 + 0.5 * y } color_map { [0 rgb <0, 0, 0.94>] [1 rgb <0, 3, 0.94>] }]
	[1 rgb <0, 0, 0.94>]
} } }
)";

const char* const exactly = "method \"exact\" tolerance 1e-5";

struct Frame {
	Picture picture;
	int id(int x, int y) const { return int(std::lround(picture.at(x, y, 2) * 16)); } // 0: black; 15: the sky
	double place(int x, int y, int axis) const { return (picture.at(x, y, axis) * 2 - 1) * (id(x, y) == 15 ? 1 : range); }
};

std::string with(const std::string& hole) { return scene + std::string("blackhole { 0, 1 effect_radius 40 ") + hole + " }"; }

std::vector<Frame> film(const std::string& hole) {
	const Rendering run = povray(with(hole), width, height, "+KFI1 +KFF" + std::to_string(frames));
	std::vector<Frame> all;
	for (int i = 1; i <= frames; i++) {
		char name[40];
		std::snprintf(name, sizeof name, "/scene%03d.ppm", i);
		all.push_back({read_ppm(run.folder + name)});
		if (all.back().picture.samples.empty()) {
			ADD_FAILURE() << name << "\n" << run.text;
			return {};
		}
	}
	return all;
}

// Whether the exact frame may show this kind here: it has an edge within a pixel, or the kind within two. Looked at with eight
// times the pixels, for some images are thinner than one.
bool may_show(const std::vector<Frame>& exact, int frame, int x, int y, int id) {
	const int left = std::max(0, x - 2), right = std::min(width, x + 3), top = std::max(0, y - 2),
			  bottom = std::min(height, y + 3);
	const Frame& e = exact[std::size_t(frame)];
	for (int j = y - 1; j <= y + 1; j++)
		for (int i = x - 1; i <= x + 1; i++)
			if (e.id(i, j) != e.id(x, y)) // an edge: what is just hidden behind it may come out
				return true;
	const auto word = [](const char* name, int value) { return name + std::to_string(value); };
	const Frame fine{povray(with(exactly), width * 8, height * 8,
		"+K" + number(double(frame) / (frames - 1)) + word(" +SC", left * 8 + 1) + word(" +EC", right * 8) +
			word(" +SR", top * 8 + 1) + word(" +ER", bottom * 8))
						 .picture};
	for (int j = top * 8; j < bottom * 8; j++)
		for (int i = left * 8; i < right * 8; i++)
			if (fine.id(i, j) == id)
				return true;
	return false;
}

double median(std::vector<double> list) {
	std::nth_element(list.begin(), list.begin() + long(list.size() / 2), list.end());
	return list[list.size() / 2];
}

class Film : public testing::TestWithParam<const char*> {};

} // namespace

TEST_P(Film, HasNoPops) {
	const double tolerance = std::atof(GetParam());
	static const std::vector<Frame> exact = film(exactly);
	const std::vector<Frame> seen = film("tolerance " + std::string(GetParam()));
	ASSERT_EQ(seen.size(), std::size_t(frames));
	ASSERT_EQ(exact.size(), std::size_t(frames));

	int edges = 0, astray = 0;
	// Of the error of objects' places, over the tolerance: the median, over each frame's pixels, of its change since the frame
	// before.
	std::vector<double> change;
	for (int i = 0; i < frames; i++) {
		std::vector<double> changes;
		for (int y = 1; y < height - 1; y++)
			for (int x = 1; x < width - 1; x++) {
				const Frame &a = seen[std::size_t(i)], &e = exact[std::size_t(i)];
				const int id = a.id(x, y);
				if (id != e.id(x, y)) {
					edges++;
					if (!may_show(exact, i, x, y, id)) {
						astray++;
						std::printf("frame %d, pixel %d %d: %d, not %d\n", i + 1, x, y, id, e.id(x, y));
					}
				}
				if (i == 0 || id == 0 || id == 15)
					continue;
				const Frame &a0 = seen[std::size_t(i - 1)], &e0 = exact[std::size_t(i - 1)];
				if (e.id(x, y) != id || a0.id(x, y) != id || e0.id(x, y) != id)
					continue;
				for (int axis = 0; axis < 2; axis++) {
					const double error = a.place(x, y, axis) - e.place(x, y, axis),
								 before = a0.place(x, y, axis) - e0.place(x, y, axis);
					changes.push_back(std::fmin(0.3, std::fabs(error - before) / (tolerance * (id < 8 ? 4 : 8))));
				}
			}
		if (i > 0) {
			ASSERT_GT(changes.size(), 200u);
			change.push_back(std::accumulate(changes.begin(), changes.end(), 0.0) / double(changes.size()));
		}
	}
	// Against the frames around it: errors grow as the camera comes near.
	double most = 0;
	int when = 0;
	for (int i = 0; i < int(change.size()); i++) {
		const int first = std::min(std::max(i - 5, 0), int(change.size()) - 11);
		const double ratio = change[std::size_t(i)] / median({change.begin() + first, change.begin() + first + 11});
		if (ratio > most) {
			most = ratio;
			when = i + 2;
		}
	}
	std::printf("tolerance %g: %d pixels at edges differ in kind, %d elsewhere; the error of places changes by %.4f of the "
				"tolerance from frame to frame, at most %.2f times as much as in the frames around (frame %d)\n",
		tolerance, edges, astray, median(change), most, when);
	EXPECT_EQ(astray, 0);
	EXPECT_LT(most, 2);
}

INSTANTIATE_TEST_SUITE_P(At, Film, testing::Values("1e-2", "2e-3"));
