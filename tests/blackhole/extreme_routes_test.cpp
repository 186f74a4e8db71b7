// SPDX-License-Identifier: AGPL-3.0-or-later
/// The rays of extremes.h by the atlas, where it has them: what it may not know it must leave to a path.
#include "extremes.h"

#include "blackhole/route.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

using namespace blackhole;
using extremes::Ray;
using extremes::words;

namespace {

struct Worst {
	long rays = 0, charted = 0, through = 0, chords = 0;
	double direction = 0, place = 0, off = 0, drift = 0; // over the tolerance
};

// What does not hold of a ray that the atlas has, or an empty string.
std::string check(const Ray& ray, const Atlas& atlas, Worst& worst) {
	const double R = ray.settings.effect_radius, tolerance = ray.settings.tolerance;
	worst.rays++;
	double margin;
	const bool escapes = extremes::witness(ray, margin) == Outcome::escaped;
	Escape exact, across;
	escape(ray.x, ray.d, R, exact);
	// Where it enters from outside, as Bent_Path asks.
	if (std::fabs(length(ray.x) / R - 1) < 4e-16 && dot(ray.x, ray.d) < 0 && atlas.through(ray.x, ray.d, across)) {
		worst.through++;
		if (!escapes)
			return "through() has a captured ray";
		const double off = std::max(length(across.tangent - exact.tangent), length(across.at - exact.at)) / tolerance;
		worst.direction = std::max(worst.direction, off);
		if (!(off < 1))
			return words("through() is off by %g of the tolerance", off);
	}
	Route route;
	if (!route.solve(ray.x, ray.d, atlas, ray.ramp))
		return {};
	worst.charted++;
	if ((route.outcome() == Outcome::escaped) != escapes)
		return words("the route's outcome is wrong, margin %g", margin);
	const double drift = route.drift() / tolerance;
	worst.drift = std::max(worst.drift, drift);
	if (!(drift <= 1))
		return words("drift %g of the tolerance", drift);
	const Vec3 end = route.end();
	if (!(std::fabs(length(route.end_tangent()) - 1) < 1e-14) ||
		!(std::fabs(length(end) / (escapes ? R : 1) - 1) < 0.01 * tolerance))
		return words("ends at radius %.17g", length(end));
	const Exact_Orbit curve(ray.x, ray.d);
	Vec3 at = ray.x;
	double phi = 0;
	long count = 0;
	for (Chord c; route.next(c);) {
		if (++count > 100000)
			return "chords without end";
		if (length(c.from - at) != 0 || !std::isfinite(length(c.to)) || !std::isfinite(c.nearest) || !std::isfinite(c.farthest))
			return words("chord %ld does not join, or is no number", count);
		at = c.to;
		const double start = std::atan2(dot(c.from, curve.e2()), dot(c.from, curve.e1()));
		const auto since = [&](const Vec3& q) {
			const double more = std::atan2(dot(q, curve.e2()), dot(q, curve.e1())) - start;
			return phi + (more < -3.14159265 ? more + 6.283185307179586 : more > 3.14159265 ? more - 6.283185307179586 : more);
		};
		for (double part : {0.5, 1.0}) {
			const Vec3 q = (1 - part) * c.from + part * c.to;
			const double off = extremes::distance(curve, since(q), length(q)) / tolerance;
			worst.off = std::max(worst.off, off);
			if (!(off < 1))
				return words("chord %ld is %g of the tolerance off at part %g, radius %.17g", count, off, part, length(q));
		}
		phi = since(c.to);
	}
	worst.chords += count;
	if (count == 0 || !(length(at - end) <= 1e-12 * length(end)))
		return "the last chord does not end where the route does";
	if (escapes) {
		const double direction = length(route.end_tangent() - exact.tangent) / tolerance,
					 place = length(end - R * exact.at) / (R * tolerance);
		worst.direction = std::max(worst.direction, direction);
		worst.place = std::max(worst.place, place);
		if (!(direction < 1 && place < 1))
			return words("exit off by %g of the tolerance in direction, %g in place", direction, place);
	}
	return {};
}

} // namespace

namespace {

// From the effect sphere past the hole, as cameras outside look at it: b to 20 Rs, in any plane.
Ray aimed(const Settings& s, std::mt19937_64& random) {
	std::uniform_real_distribution<double> u(0, 1);
	std::normal_distribution<double> n;
	const double R = s.effect_radius, b = std::min(0.9 * R, 20 * u(random)), sine = b / R / std::sqrt(1 + b * b / (R * R * R));
	const Vec3 e = unit({n(random), n(random), n(random)}), t = unit(cross(e, {n(random), n(random), n(random)}));
	Ray ray;
	ray.x = R * e;
	ray.d = -std::sqrt(1 - sine * sine) * e + sine * t;
	return ray;
}

} // namespace

TEST(Extremes_Routes, KeepEveryPromise) {
	const Settings settings[] = {{1000, 1e-3, Method::rk4}, {10, 1e-4, Method::rk4}, {1.6, 1e-2, Method::rk4},
		{1e6, 5e-4, Method::dopri5}, {1e12, 1e-4, Method::rk4}, {1e15, 5e-4, Method::rk4}, {1.5000001, 1e-3, Method::rk4}};
	int failures = 0;
	for (const Settings& s : settings) {
		const Atlas atlas(s);
		Worst worst;
		for (int kind = 0; kind <= extremes::kinds; kind++) {
			std::mt19937_64 random(std::uint64_t(300 + kind));
			for (int i = 0; i < 6000 && failures < 20; i++) {
				Ray ray = kind == extremes::kinds ? aimed(s, random) : generate(extremes::Kind(kind), random);
				if (kind == extremes::effect_sphere || (i % 4 == 0 && length(ray.x) > s.effect_radius))
					ray.x = (s.effect_radius / length(ray.x)) * ray.x;
				ray.settings = s;
				if (!allowed(ray))
					continue;
				const std::string what = check(ray, atlas, worst);
				EXPECT_EQ(what, "") << kind << ": " << ray.text();
				failures += !what.empty();
			}
		}
		std::printf(
			"[ extremes ] R %g, tolerance %g: %ld of %ld rays charted, %ld across; %.1f chords; direction %.3f, place %.3f, "
			"chords off %.3f, drift %.3f of the tolerance\n",
			s.effect_radius, s.tolerance, worst.charted, worst.rays, worst.through,
			double(worst.chords) / double(std::max(1L, worst.charted)), worst.direction, worst.place, worst.off, worst.drift);
		EXPECT_GT(worst.charted + worst.through, s.effect_radius < 1.6 ? 0 : 500);
	}
}
