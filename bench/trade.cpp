// SPDX-License-Identifier: AGPL-3.0-or-later
/// Measures the trade of time for accuracy for bench/trade, which knows how to read this:
///
///   trade [--quick]   one CSV line for each scene, method, setting and effect radius; --quick: a few, by few pixels
///
/// Time: CPU microseconds of this thread for a ray, as bent light costs it in pictures: frames, path, chords, and looking for one
/// plane; the least of three rounds, each of all settings in turn. Errors: percentiles over pixels that are not black
/// both as traced and in truth. "wrong": the share of all pixels that show another thing than they should.
#include "trade.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>

using namespace trade;

namespace {

struct Setting {
	std::string method;
	double value, R;
};

struct Result {
	double us = 1e300, wrong = 0, band = 0, clear_max = 0; // clear: outside 0.1 % of b_c
	std::vector<float> pixels, radians;
};

double now() {
	timespec t;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
	return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double share(std::vector<float>& sorted, double part) {
	return sorted.empty() ? 0 : sorted[std::min(sorted.size() - 1, std::size_t(part * double(sorted.size())))];
}

void print(const char* scene, const Setting& s, Result& r) {
	std::sort(r.pixels.begin(), r.pixels.end());
	std::sort(r.radians.begin(), r.radians.end());
	std::printf("%s,%s,%g,%g,%.4g", scene, s.method.c_str(), s.value, s.R, r.us);
	for (std::vector<float>* v : {&r.pixels, &r.radians})
		for (double part : {0.5, 0.99, 0.999, 1.0})
			std::printf(",%.3g", share(*v, part));
	std::printf(",%.3g,%.3g,%.3g\n", r.clear_max, r.wrong, r.band);
	std::fflush(stdout);
}

std::vector<Setting> settings(bool quick) {
	using List = std::vector<double>;
	const List tolerances =
		quick ? List{1e-2, 1e-3, 5e-4, 1e-4} : List{5e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 1e-5, 1e-6};
	const List radii = quick ? List{100, 1000, 10000} : List{30, 100, 300, 1000, 3000, 10000, 100000};
	std::vector<Setting> all;
	for (double R : radii) {
		for (const char* method : blackhole::method_names)
			for (double t : tolerances)
				all.push_back({method, t, R});
		all.push_back({"sky", 0, R});
		// Steps that never see the hole, or number more than 20,000, are left out.
		for (double h : quick ? List{0.1} : List{1, 0.3, 0.1, 0.03, 0.01})
			if (R / h < 2e4)
				all.push_back({"euler", h, R});
		for (double h : quick ? List{0.1, 0.01} : List{0.3, 0.1, 0.03, 0.01, 0.003, 0.001})
			all.push_back({"euler-r", h, R});
	}
	return all;
}

std::vector<Pixel> pixels(const Scene& scene, int across) {
	const double apart = width / across;
	std::vector<Pixel> all;
	// Off the middle of their squares, so that none is exactly radial.
	for (double y = 0.37 * apart - height / 2; y < height / 2; y += apart)
		for (double x = 0.41 * apart - width / 2; x < width / 2; x += apart)
			all.emplace_back(scene, x, y);
	return all;
}

// One pass, of every so manieth pixel. Returns microseconds for each.
double time_pass(Tracer& tracer, const Scene& scene, const std::vector<Vec3>& rays, std::size_t every, std::vector<Seen>& seen) {
	const double start = now();
	for (std::size_t i = 0; i < rays.size(); i += every)
		seen[i] = tracer.trace(scene, rays[i]);
	return (now() - start) * 1e6 / double((rays.size() + every - 1) / every);
}

void judge(const std::vector<Pixel>& pixels, const std::vector<Seen>& seen, std::size_t every, Result& r) {
	std::size_t wrong = 0, band = 0, count = 0;
	for (std::size_t i = 0; i < pixels.size(); i += every) {
		const Seen &truth = pixels[i].truth(), &s = seen[i];
		const bool same = s.same(truth), near = truth.beside < 1e-3;
		count++;
		wrong += !same;
		band += near;
		if (same && s.kind == Seen::black)
			continue;
		const double shift = pixels[i].shift(s);
		r.pixels.push_back(float(shift));
		if (!near)
			r.clear_max = std::max(r.clear_max, shift);
		if (same)
			r.radians.push_back(float(pixels[i].angle(s)));
	}
	r.wrong = double(wrong) / double(count);
	r.band = double(band) / double(count);
}

void measure(const std::vector<Setting>& all, int across, int rounds) {
	std::printf(
		"scene,method,tolerance_or_step,effect_radius,us_per_ray,median_px,p99_px,p999_px,max_px,median_rad,p99_rad,p999_rad,"
		"max_rad,clear_max_px,wrong,band\n");
	for (const Scene& scene : scenes()) {
		const double off = witness(scene, 12);
		std::fprintf(
			stderr, "trade: %s: %s; exact answers are within %.1g of those by quadrature\n", scene.name, scene.what, off);
		if (!(off < 1e-9))
			throw std::runtime_error("the exact answers are wrong");
		const std::vector<Pixel> picture = pixels(scene, across);
		std::vector<Vec3> rays;
		for (const Pixel& p : picture)
			rays.push_back(p.direction());
		std::vector<Seen> seen(rays.size());
		std::vector<Result> results(all.size());
		for (int round = 0; round < rounds; round++)
			for (std::size_t i = 0; i < all.size(); i++) {
				const Setting& s = all[i];
				const bool euler = s.method.rfind("euler", 0) == 0;
				if ((s.method == "sky" && scene.has_plane) || (euler && round > 0))
					continue;
				const std::unique_ptr<Tracer> t = tracer(s.method, s.value, s.R);
				// Where errors are coarse, or steps many, fewer rays do.
				const std::size_t every = euler ? (s.value < 0.05 ? 13 : 3) : s.R < 1000 ? 3 : 1;
				results[i].us = std::min(results[i].us, time_pass(*t, scene, rays, every, seen));
				if (round == 0)
					judge(picture, seen, every, results[i]);
			}
		for (std::size_t i = 0; i < all.size(); i++)
			if (results[i].us < 1e300)
				print(scene.name, all[i], results[i]);
	}
}

} // namespace

int main(int count, char** argument) {
	const bool quick = count == 2 && !std::strcmp(argument[1], "--quick");
	if (count > 1 && !quick) {
		std::fprintf(stderr, "trade [--quick]\n");
		return 2;
	}
	try {
		measure(settings(quick), quick ? 48 : 96, quick ? 1 : 3);
	} catch (std::exception& e) {
		std::fprintf(stderr, "trade: %s\n", e.what());
		return 1;
	}
}
