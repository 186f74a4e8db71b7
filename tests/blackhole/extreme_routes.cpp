// SPDX-License-Identifier: AGPL-3.0-or-later
#include "extremes.h"

#include "blackhole/route.h"

#include <algorithm>
#include <vector>

using namespace blackhole;

namespace extremes {

// Pieces of any length must hold their chords, of these corners, and lie at the radii they say.
static std::string check_pieces(const Route& route, const std::vector<Vec3>& corners, double tolerance) {
	const int chords = static_cast<int>(corners.size()) - 1;
	if (chords != route.chords())
		return words("%d chords of %d", chords, route.chords());
	for (int many = 1; many == 1 || many <= 0.3 / std::sqrt(tolerance); many *= 4)
		for (int first = 0; first < chords;) {
			Pieces p;
			const int count = route.pieces(first, chords, many, p);
			if (count < 1 || count > 4)
				return words("%d pieces", count);
			for (int i = 0; i < count; i++, first += many)
				for (int j = first; j <= std::min(first + many, chords); j++) {
					const Vec2 along{p.dx[i], p.dy[i]},
						off = Vec2{dot(corners[j], route.e1()), dot(corners[j], route.e2())} - Vec2{p.x[i], p.y[i]};
					const double square = dot(along, along), t = square > 0 ? std::clamp(dot(off, along) / square, 0.0, 1.0) : 0;
					if (!(length(off - t * along) <= p.bulge[i]))
						return words("corner %d is %g off a piece of %d chords that is %g wide", j, length(off - t * along), many,
							p.bulge[i]);
					if (!(length(corners[j]) <= p.farthest[i]) ||
						(j > first && !(length(0.5 * (corners[j] + corners[j - 1])) >= p.nearest[i])))
						return words("chord %d is outside of the radii of its piece of %d", j, many);
				}
		}
	return {};
}

std::string check(const Ray& ray, const Atlas& atlas, Charted_Figures& worst) {
	const double R = ray.settings.effect_radius, tolerance = ray.settings.tolerance;
	worst.rays++;
	double margin;
	const bool escapes = witness(ray, margin) == Outcome::escaped;
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
	std::vector<Vec3> corners{at};
	for (Chord c; route.next(c);) {
		if (++count > 100000)
			return "chords without end";
		if (length(c.from - at) != 0 || !std::isfinite(length(c.to)) || !std::isfinite(c.nearest) || !std::isfinite(c.farthest))
			return words("chord %ld does not join, or is no number", count);
		at = c.to;
		corners.push_back(at);
		const double start = std::atan2(dot(c.from, curve.e2()), dot(c.from, curve.e1()));
		const auto since = [&](const Vec3& q) {
			const double more = std::atan2(dot(q, curve.e2()), dot(q, curve.e1())) - start;
			return phi + (more < -3.14159265 ? more + 6.283185307179586 : more > 3.14159265 ? more - 6.283185307179586 : more);
		};
		for (double part : {0.5, 1.0}) {
			const Vec3 q = (1 - part) * c.from + part * c.to;
			const double off = distance(curve, since(q), length(q)) / tolerance;
			worst.off = std::max(worst.off, off);
			if (!(off < 1))
				return words("chord %ld is %g of the tolerance off at part %g, radius %.17g", count, off, part, length(q));
		}
		phi = since(c.to);
	}
	worst.chords += count;
	if (count == 0 || !(length(at - end) <= 1e-12 * length(end)))
		return "the last chord does not end where the route does";
	if (const std::string wrong = check_pieces(route, corners, tolerance); !wrong.empty())
		return wrong;
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

void Charted_Figures::add(const Charted_Figures& other) {
	rays += other.rays;
	charted += other.charted;
	through += other.through;
	chords += other.chords;
	direction = std::max(direction, other.direction);
	place = std::max(place, other.place);
	off = std::max(off, other.off);
	drift = std::max(drift, other.drift);
}

std::string Charted_Figures::line() const {
	return words("%ld %ld %ld %ld %.17g %.17g %.17g %.17g", rays, charted, through, chords, direction, place, off, drift);
}

bool Charted_Figures::read(std::istream& in) {
	return bool(in >> rays >> charted >> through >> chords >> direction >> place >> off >> drift);
}

void Charted_Figures::print(const char* name) const {
	std::printf("[ extremes ] %s: %ld of %ld rays charted, %ld across; %.1f chords; direction %.3f, place %.3f, chords off %.3f, "
				"drift %.3f of the tolerance\n",
		name, charted, rays, through, double(chords) / double(std::max(1L, charted)), direction, place, off, drift);
}

// From the effect sphere past the hole, as cameras outside look at it.
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

bool generate(int kind, const Settings& settings, bool entering, std::mt19937_64& random, Ray& ray) {
	ray = kind == kinds ? aimed(settings, random) : generate(Kind(kind), random);
	if (kind == effect_sphere || (entering && length(ray.x) > settings.effect_radius))
		ray.x = (settings.effect_radius / length(ray.x)) * ray.x;
	ray.settings = settings;
	return allowed(ray);
}

} // namespace extremes
