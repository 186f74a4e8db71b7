// SPDX-License-Identifier: AGPL-3.0-or-later
/// A ray's way as source/backend/blackhole takes it: straight to the effect sphere, bent inside it, straight on.
#include "trade.h"

#include "blackhole/frames.h"
#include "blackhole/route.h"

#include <algorithm>
#include <stdexcept>

namespace trade {

using namespace blackhole;

// Along x + t d, d unit, up to most; moves x to the end, or to the hit.
bool Tracer::straight(Vec3& x, const Vec3& d, double most, const Plane* plane, Seen& seen) const {
	if (plane) {
		const double t = -plane->side(x) / dot(plane->normal, d);
		if (t > 0 && t < most) {
			const Vec3 p = x + t * d;
			if (plane->holds(p)) {
				x = p;
				seen.kind = Seen::object;
				return true;
			}
			seen.crossing++;
		}
	}
	if (most < 1e300)
		x = x + most * d;
	return false;
}

Seen Tracer::trace(const Scene& scene, const Vec3& n) {
	Seen seen;
	const Plane* plane = scene.has_plane ? &scene.plane : nullptr;
	Vec3 x = scene.eye, d = n;
	for (bool camera = true;; camera = false) {
		seen.kind = Seen::sky;
		if (length(x) < R_)
			d = static_to_coordinate(x, d, R_);
		bool hit = false, meets = true;
		if (length(x) >= R_) {
			const double along = dot(x, d), square = along * along - dot(x, x) + R_ * R_;
			meets = along < 0 && square > 0;
			hit = straight(x, d, meets ? -along - std::sqrt(square) : INFINITY, plane, seen);
		}
		if (meets && !hit) {
			bend(x, d, plane, camera, seen);
			hit = seen.kind == Seen::object;
			if (seen.kind == Seen::sky)
				hit = straight(x, d, INFINITY, plane, seen);
		}
		if (hit && scene.plane.mirror) {
			// Reflected as the observer at rest there sees it.
			const Vec3 in = coordinate_to_static(x, d, R_), normal = unit(normal_to_static(x, plane->normal, R_));
			d = unit(in - (2 * dot(in, normal)) * normal);
			plane = nullptr;
			seen.mirrored = true;
			seen.crossing = 0;
			continue;
		}
		if (hit)
			seen.what = x;
		else {
			if (seen.kind == Seen::sky)
				seen.what = d;
			seen.crossing = 0;
		}
		return seen;
	}
}

namespace {

class Closed : public Tracer {
public:
	explicit Closed(double R) : Tracer(R) {}
	void bend(Vec3& x, Vec3& d, const Plane*, bool, Seen& seen) override {
		Escape out;
		seen.kind = escape(x, d, R_, out) ? Seen::sky : Seen::black;
		x = R_ * out.at;
		d = out.tangent;
	}
};

class Ours : public Tracer {
public:
	Ours(Method method, double tolerance, double R)
		: Tracer(R), settings_{R, tolerance, method}, in_arc_(std::min(32, int(0.25 / std::sqrt(tolerance)))), atlas_(settings_) {
	}

	void bend(Vec3& x, Vec3& d, const Plane* plane, bool camera, Seen& seen) override {
		if (route_.solve(x, d, atlas_, !camera)) {
			if (!walk(route_, x, d, plane, seen))
				leave(route_, x, d, seen);
			return;
		}
		path_.solve(x, d, settings_);
		Chords chords(path_, settings_.tolerance, !camera);
		if (!walk(chords, x, d, plane, seen))
			leave(path_, x, d, seen);
	}

private:
	// As bentsearch.cpp: arcs first, fewer chords at a time where they may meet something. Whether something is hit.
	template <typename Walk> bool walk(Walk& walk, Vec3& x, Vec3& d, const Plane* plane, Seen& seen) const {
		Chord c;
		if (in_arc_ < 2) {
			while (walk.next(c))
				if (plane && meets(walk, *plane, c, x, d, seen))
					return true;
			return false;
		}
		const int fewer = std::max(1, int(std::sqrt(in_arc_) + 0.5));
		Arc arc, part;
		for (;;) {
			const typename Walk::Bookmark here = walk.bookmark();
			if (!walk.next(arc, in_arc_))
				return false;
			if (!plane || !near(*plane, arc))
				continue;
			walk.go_to(here);
			for (int i = 0; i < arc.chords; i += part.chords) {
				const typename Walk::Bookmark there = walk.bookmark();
				if (!walk.next(part, std::min(fewer, arc.chords - i)))
					break;
				if (!near(*plane, part))
					continue;
				walk.go_to(there);
				for (int j = 0; j < part.chords && walk.next(c); j++)
					if (meets(walk, *plane, c, x, d, seen))
						return true;
			}
		}
	}
	template <typename Way> static void leave(const Way& way, Vec3& x, Vec3& d, Seen& seen) {
		seen.kind = way.outcome() == Outcome::captured ? Seen::black : Seen::sky;
		x = way.end();
		d = way.end_tangent();
	}
	static bool near(const Plane& plane, const Arc& arc) {
		const double p = plane.side(arc.from), q = plane.side(arc.to);
		return p * q <= 0 || std::min(std::fabs(p), std::fabs(q)) <= arc.bulge;
	}
	template <typename Walk>
	bool meets(const Walk& walk, const Plane& plane, const Chord& c, Vec3& x, Vec3& d, Seen& seen) const {
		const double p = plane.side(c.from), q = plane.side(c.to);
		if (p == 0 || (p > 0) == (q > 0))
			return false;
		const double t = p / (p - q);
		const Vec3 hit = c.from + t * (c.to - c.from);
		if (!plane.holds(hit)) {
			seen.crossing++;
			return false;
		}
		x = hit;
		d = unit((1 - 4 * t + 3 * t * t) * walk.tangent(c.at_from) + (3 * t * t - 2 * t) * walk.tangent(c.at_to) +
				 (6 * t - 6 * t * t) * unit(c.to - c.from));
		seen.kind = Seen::object;
		return true;
	}
	Settings settings_;
	int in_arc_;
	Atlas atlas_;
	Route route_;
	Path path_;
};

/// Euler's method on the Cartesian orbit. Captured is what comes below r = 1. It gets our frames and our effect sphere, which
/// the programs of the 1990s had not.
class Euler : public Tracer {
public:
	Euler(double step, bool of_r, double R) : Tracer(R), step_(step), of_r_(of_r) {}
	void bend(Vec3& x, Vec3& d, const Plane* plane, bool, Seen& seen) override {
		Vec3 v = unit(d);
		const Vec3 h = cross(x, v);
		const double h2 = dot(h, h);
		for (int i = 0; i < 10000000; i++) {
			const double r2 = dot(x, x), r = std::sqrt(r2), dt = of_r_ ? step_ * r : step_;
			if (r < 1)
				break;
			if (i > 0 && r >= R_ && dot(x, v) > 0) {
				seen.kind = Seen::sky;
				d = unit(v);
				return;
			}
			const Vec3 from = x;
			x = x + dt * v;
			v = v - (dt * 1.5 * h2 / (r2 * r2 * r)) * from;
			if (!plane)
				continue;
			const double p = plane->side(from), q = plane->side(x);
			if (p == 0 || (p > 0) == (q > 0))
				continue;
			const Vec3 hit = from + (p / (p - q)) * (x - from);
			if (plane->holds(hit)) {
				d = unit(x - from);
				x = hit;
				seen.kind = Seen::object;
				return;
			}
			seen.crossing++;
		}
		seen.kind = Seen::black;
	}

private:
	double step_;
	bool of_r_;
};

} // namespace

std::unique_ptr<Tracer> tracer(const std::string& method, double setting, double R) {
	Method ours;
	if (method == "sky")
		return std::make_unique<Closed>(R);
	if (method == "euler" || method == "euler-r")
		return std::make_unique<Euler>(setting, method == "euler-r", R);
	if (find_method(method.c_str(), ours))
		return std::make_unique<Ours>(ours, setting, R);
	throw std::invalid_argument("no method '" + method + "'");
}

} // namespace trade
