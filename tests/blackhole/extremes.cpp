// SPDX-License-Identifier: AGPL-3.0-or-later
#include "extremes.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <iterator>
using namespace blackhole;

namespace extremes {
namespace {

using Quad = __float128;

Quad root(Quad a) {
	if (!(a > 0))
		return 0;
	// Directions are subnormal or huge: to a double's range first, by powers of four.
	Quad scale = 1;
	for (; a > Quad(1e200); a /= Quad(0x1p600))
		scale *= Quad(0x1p300);
	for (; a < Quad(1e-200); a *= Quad(0x1p600))
		scale /= Quad(0x1p300);
	Quad y = std::sqrt(static_cast<double>(a));
	for (int i = 0; i < 3; i++)
		y = (y + a / y) / 2;
	return y * scale;
}

struct Exact {
	Quad r, r2, d2, s, h2; // |x|, |x|^2, |d|^2, x.d, |x cross d|^2
	explicit Exact(const Ray& ray) {
		const Quad a = ray.x.x, b = ray.x.y, c = ray.x.z, e = ray.d.x, f = ray.d.y, g = ray.d.z;
		const Quad i = b * g - c * f, j = c * e - a * g, k = a * f - b * e;
		r2 = a * a + b * b + c * c;
		d2 = e * e + f * f + g * g;
		s = a * e + b * f + c * g;
		h2 = i * i + j * j + k * k;
		r = root(r2);
	}
};

bool finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

} // namespace

std::string words(const char* format, ...) {
	char text[400];
	va_list list;
	va_start(list, format);
	std::vsnprintf(text, sizeof text, format, list);
	va_end(list);
	return text;
}

std::string Ray::text() const {
	return words("x {%a, %a, %a} d {%a, %a, %a} R %a tolerance %a %s ramp %d (r %.17g, R %.17g, tolerance %.3g)", x.x, x.y, x.z,
		d.x, d.y, d.z, settings.effect_radius, settings.tolerance, method_names[int(settings.method)], int(ramp), length(x),
		settings.effect_radius, settings.tolerance);
}

bool allowed(const Ray& ray) {
	const Settings& s = ray.settings;
	if (!finite(ray.x) || !finite(ray.d) || !(s.effect_radius > 1.5 && s.effect_radius <= 1e15) ||
		!(s.tolerance >= 1e-9 && s.tolerance <= 0.1))
		return false;
	const Exact e(ray);
	if (!(e.d2 > 0) || !(e.r > Quad(1e-6)) || !(e.r <= Quad(s.effect_radius) * (1 + Quad(4e-16))))
		return false;
	if (e.r > 1)
		return true;
	return e.s > 0 && e.h2 < e.r2 * e.r * e.d2;
}

Outcome witness(const Ray& ray, double& margin) {
	const Exact e(ray);
	// 1/b^2 against 4/27, times b^2's like: w^2 (u + 1/3) - s^2 / (r^2 h^2) with w = u - 2/3, which keeps its digits next to the
	// photon sphere, where b^2 - 27/4 would lose them.
	const Quad u = 1 / e.r, w = (Quad(1.5) - e.r) * u / Quad(1.5);
	const Quad barrier = w * w * (u + Quad(1) / 3) * e.r2 * e.h2, falls = e.s * e.s, beyond = barrier - falls;
	margin = barrier + falls > 0 ? std::fabs(double(beyond / (barrier + falls))) : 0;
	const Quad side = e.r - Quad(1.5);
	if (side == 0) {
		margin = double(e.s * e.s / (e.r2 * e.d2));
		return e.s > 0 ? Outcome::escaped : Outcome::captured;
	}
	if (side > 0)
		return e.s >= 0 || beyond > 0 ? Outcome::escaped : Outcome::captured;
	return e.s > 0 && beyond < 0 ? Outcome::escaped : Outcome::captured;
}

namespace {

constexpr long Figures::*counts[] = {&Figures::rays, &Figures::captured, &Figures::near, &Figures::nudged, &Figures::oracle,
	&Figures::back, &Figures::turned, &Figures::nodes, &Figures::chords, &Figures::most_nodes, &Figures::most_chords};
constexpr std::size_t sums = 9; // the rest are largest ones
constexpr double Figures::*largest[] = {
	&Figures::drift, &Figures::off, &Figures::direction, &Figures::back_off, &Figures::swept, &Figures::steps};

} // namespace

void Figures::add(const Figures& f) {
	for (std::size_t i = 0; i < std::size(counts); i++)
		this->*counts[i] = i < sums ? this->*counts[i] + f.*counts[i] : std::max(this->*counts[i], f.*counts[i]);
	for (double Figures::*n : largest)
		this->*n = std::max(this->*n, f.*n);
	closest = std::min(closest, f.closest);
}

std::string Figures::line() const {
	std::string text;
	for (long Figures::*n : counts)
		text += words("%ld ", this->*n);
	for (double Figures::*n : largest)
		text += words("%.17g ", this->*n);
	return text + words("%.17g", closest);
}

bool Figures::read(std::istream& in) {
	for (long Figures::*n : counts)
		in >> this->*n;
	for (double Figures::*n : largest)
		in >> this->*n;
	return bool(in >> closest);
}

void Figures::print(const char* name) const {
	std::printf("[ extremes ] %-14s %8ld rays (%4.1f %% captured, %4.1f %% within 0.1 %% of b_c, %ld nudged, closest %.1e; %ld "
				"five turns, "
				"most %.2f rad), nodes: %.1f, at most %ld, %.2f of the bound; chords %.1f, at most %ld; drift "
				"%.3f, chords off %.3f, direction %.3f of the tolerance (%ld rays), back %.3f (%ld)\n",
		name, rays, 100.0 * double(captured) / double(rays), 100.0 * double(near) / double(rays), nudged, closest, turned, swept,
		double(nodes) / double(rays), most_nodes, steps, double(chords) / double(rays), most_chords, drift, off, direction,
		oracle, back_off, back);
}

} // namespace extremes
