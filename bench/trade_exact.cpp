// SPDX-License-Identifier: AGPL-3.0-or-later
/// What is there to see, and how far from it a picture is.
#include "trade.h"

#include "blackhole/oracle.h"

#include <algorithm>
#include <stdexcept>

namespace trade {

using namespace blackhole;

namespace {

// The static frame as the effect radius grows without end (blackhole/frames.h has it for a finite one).
Vec3 radial_times(const Vec3& x, const Vec3& d, double g) {
	const Vec3 e = unit(x);
	return d + ((g - 1) * dot(d, e)) * e;
}
double lapse(const Vec3& x) { return std::sqrt(1 - 1 / length(x)); }

Vec3 reflected(const Vec3& x, const Vec3& along, const Vec3& normal) {
	const Vec3 in = unit(radial_times(x, along, 1 / lapse(x))), n = unit(radial_times(x, normal, lapse(x)));
	return in - (2 * dot(in, n)) * n;
}

// The first place on the plane that it holds: roots of normal . (e(phi) - centre u(phi)), e the unit radial.
bool hit(const Plane& plane, const Exact_Orbit& orbit, Vec3& place, Vec3& along, unsigned& crossing) {
	const double p = dot(plane.normal, orbit.e1()), q = dot(plane.normal, orbit.e2()), end = orbit.end(INFINITY);
	const double offset = dot(plane.normal, plane.centre);
	const auto side = [&](double phi) { return p * std::cos(phi) + q * std::sin(phi) - offset * orbit.at(phi).u; };
	const int steps = 4 + int(end / 0.1);
	double from = 0, at_from = side(0);
	for (int i = 1; i <= steps; i++) {
		const double to = i < steps ? end * i / steps : end, at_to = side(to);
		if ((at_from > 0) != (at_to > 0)) {
			double lo = from, hi = to, phi = (lo + hi) / 2;
			for (int k = 0; k < 100 && hi - lo > 1e-15 * hi; k++) {
				const double f = side(phi), slope = q * std::cos(phi) - p * std::sin(phi) - offset * orbit.at(phi).du;
				((f > 0) == (at_from > 0) ? lo : hi) = phi;
				const double next = phi - f / slope;
				if (std::fabs(next - phi) < 1e-15)
					break;
				phi = next > lo && next < hi ? next : (lo + hi) / 2;
			}
			const Exact_Orbit::State s = orbit.at(phi);
			const Vec3 e = std::cos(phi) * orbit.e1() + std::sin(phi) * orbit.e2();
			place = (1 / s.u) * e;
			if (plane.holds(place)) {
				along = unit(-s.du * e + s.u * (std::cos(phi) * orbit.e2() - std::sin(phi) * orbit.e1()));
				return true;
			}
			crossing++;
		}
		from = to;
		at_from = at_to;
	}
	return false;
}

double beside(const Vec3& x, const Vec3& d) {
	const Launch launch(x, d);
	return std::fabs(1 / std::sqrt(launch.B) / critical_b - 1);
}

} // namespace

Seen exact(const Scene& scene, const Vec3& n) {
	Seen seen;
	Vec3 x = scene.eye, d = radial_times(x, n, lapse(x)), place, along;
	seen.beside = beside(x, d);
	if (scene.has_plane && hit(scene.plane, Exact_Orbit(x, d), place, along, seen.crossing)) {
		if (!scene.plane.mirror) {
			seen.kind = Seen::object;
			seen.what = place;
			seen.along = along;
			return seen;
		}
		d = radial_times(place, reflected(place, along, scene.plane.normal), lapse(place));
		x = place;
		seen.mirrored = true;
		seen.beside = std::min(seen.beside, beside(x, d));
	}
	seen.crossing = 0;
	Escape out;
	if (escape(x, d, INFINITY, out)) {
		seen.kind = Seen::sky;
		seen.what = out.tangent;
	}
	return seen;
}

double witness(const Scene& scene, int across) {
	constexpr double endless = 1e15;
	double worst = 0;
	const double apart = width / across;
	for (double y = apart / 3 - height / 2; y < height / 2; y += apart)
		for (double x = apart / 3 - width / 2; x < width / 2; x += apart) {
			const Vec3 n = scene.direction(x, y);
			const Seen seen = exact(scene, n);
			Vec3 from = scene.eye, d = radial_times(from, n, lapse(from)), place, along;
			if (seen.crossing > 0 || seen.beside < 1e-3)
				continue;
			const auto side = [&](const Vec3& p) { return scene.plane.side(p); };
			const bool met = scene.has_plane && oracle::first_hit(from, d, 1e4, side, place, along) && scene.plane.holds(place);
			if (seen.kind == Seen::object) {
				worst = std::max(worst, met ? length(place - seen.what) / length(place) : 1);
				continue;
			}
			if (seen.mirrored) {
				d = radial_times(place, reflected(place, along, scene.plane.normal), lapse(place));
				from = place;
			}
			Vec3 direction, at;
			const bool out = oracle::exit_direction(from, d, endless, direction, at);
			if (out != (seen.kind == Seen::sky) || met != seen.mirrored)
				worst = 1;
			else if (out)
				worst = std::max(worst, length(direction - seen.what));
		}
	return worst;
}

Pixel::Pixel(const Scene& scene, double x, double y) : scene_(&scene), x_(x), y_(y), truth_(exact(scene, direction())) {
	if (truth_.kind != Seen::black)
		differentiate();
}

// Away from the hole's place on the picture, where all stays in the orbit's plane, and across.
void Pixel::differentiate() {
	constexpr double h = 1e-3;
	const Vec3 hole = -scene_->eye;
	const double depth = dot(hole, scene_->ahead) * scene_->pixel;
	const double away_x = x_ - dot(hole, scene_->right) / depth, away_y = y_ - dot(hole, scene_->up) / depth;
	const double away = std::hypot(away_x, away_y);
	const auto slope = [&](double dx, double dy) {
		const Seen before = exact(*scene_, scene_->direction(x_ - h * dx, y_ - h * dy));
		const Seen after = exact(*scene_, scene_->direction(x_ + h * dx, y_ + h * dy));
		const Vec3 from = before.same(truth_) ? before.what : truth_.what, to = after.same(truth_) ? after.what : truth_.what;
		return (1 / (h * (before.same(truth_) + after.same(truth_)))) * (to - from);
	};
	cosine_ = away_x / away;
	sine_ = away_y / away;
	by_away_ = slope(cosine_, sine_);
	by_across_ = slope(-sine_, cosine_);
}

// Rings around the pixel, each half as wide again, until one shows the same thing.
double Pixel::nearest(const Seen& seen) const {
	constexpr int ways = 16;
	const auto shows = [&](double r, int way) {
		const double a = 2 * 3.14159265358979323846 * way / ways;
		return exact(*scene_, scene_->direction(x_ + r * std::cos(a), y_ + r * std::sin(a))).same(seen);
	};
	for (double r = 1.0 / 64; r < width; r *= 1.5)
		for (int way = 0; way < ways; way++)
			if (shows(r, way)) {
				double lo = r / 1.5, hi = r;
				for (int i = 0; i < 5; i++)
					(shows((lo + hi) / 2, way) ? hi : lo) = (lo + hi) / 2;
				return hi;
			}
	return width;
}

// Least squares: what is seen lies on a surface, the sky's sphere or the plane.
bool Pixel::step(const Seen& seen, double& dx, double& dy) const {
	const Vec3 off = seen.what - truth_.what;
	const double aa = dot(by_away_, by_away_), ac = dot(by_away_, by_across_), cc = dot(by_across_, by_across_);
	const double fa = dot(by_away_, off), fc = dot(by_across_, off), det = aa * cc - ac * ac;
	const double away = (cc * fa - ac * fc) / det, across = (aa * fc - ac * fa) / det;
	dx = away * cosine_ - across * sine_;
	dy = away * sine_ + across * cosine_;
	return std::hypot(dx, dy) < width;
}

double Pixel::shift(const Seen& seen) const {
	if (!seen.same(truth_))
		return nearest(seen);
	double dx = 0, dy = 0;
	if (seen.kind == Seen::black)
		return 0;
	if (!step(seen, dx, dy))
		return width;
	// Beside the shadow the derivative itself changes within a pixel: there the step is taken again from where it led.
	const double first = std::hypot(dx, dy);
	double x = dx, y = dy, off = angle(seen);
	for (int i = 0; i < 4 && off > 0.05; i++) {
		Pixel there(*scene_, x_ + x, y_ + y);
		if (!there.truth_.same(seen) || !(there.angle(seen) < off) || !there.step(seen, dx, dy))
			return first;
		off = there.angle(seen);
		x += dx;
		y += dy;
	}
	return std::hypot(x, y);
}

double Pixel::angle(const Seen& seen) const {
	const Vec3 off = seen.what - truth_.what;
	if (seen.kind == Seen::object)
		return length(cross(off, truth_.along)) / length(seen.what);
	return 2 * std::asin(std::min(1.0, length(off) / 2));
}

} // namespace trade
