// SPDX-License-Identifier: AGPL-3.0-or-later
/// Our side of bench/rays: the closed form, paths, and paths walked chord by chord.
#include "rays.h"

#include "blackhole/chords.h"
#include "blackhole/closed.h"
#include "blackhole/route.h"

#include <sstream>

namespace bench {
namespace {

using namespace blackhole;

class Closed : public Code {
public:
	void trace(const std::vector<Ray>& rays, std::vector<Answer>& answers) override {
		for (std::size_t i = 0; i < rays.size(); i++) {
			Escape out;
			Answer& a = answers[i];
			a.captured = !escape(rays[i].x, rays[i].d, far, out);
			if (!a.captured)
				a.direction = out.tangent;
			a.failed = false;
			a.r = far;
			a.points = 1;
		}
	}
};

class Direction : public Code {
public:
	explicit Direction(double tolerance) : settings_{far, tolerance, Method::rk4} {}
	void trace(const std::vector<Ray>& rays, std::vector<Answer>& answers) override {
		for (std::size_t i = 0; i < rays.size(); i++) {
			Answer& a = answers[i];
			solve(rays[i], a);
			a.points = static_cast<unsigned>(path_.nodes().size());
		}
	}

protected:
	void solve(const Ray& ray, Answer& a) {
		a.failed = !path_.solve(ray.x, ray.d, settings_);
		a.captured = path_.outcome() == Outcome::captured;
		a.r = far;
		if (!a.captured)
			a.direction = path_.end_tangent();
	}
	Settings settings_;
	Path path_;
};

/// With the points that the integrator went by, as GYOTO gives them: what is between them is not known to be near.
class Nodes : public Direction {
public:
	using Direction::Direction;
	void trace(const std::vector<Ray>& rays, std::vector<Answer>& answers) override {
		for (std::size_t i = 0; i < rays.size(); i++) {
			Answer& a = answers[i];
			solve(rays[i], a);
			const Orbit& orbit = path_.orbit();
			for (const Node& n : path_.nodes())
				sum_ = sum_ + orbit.point(n.u, std::cos(orbit.k * n.s), std::sin(orbit.k * n.s)); // every point is asked for
			a.points = static_cast<unsigned>(path_.nodes().size());
		}
	}

private:
	Vec3 sum_{0, 0, 0};
};

/// With chords, no farther from the path than the tolerance allows: by the atlas, made beforehand, or else by a path.
class Polyline : public Direction {
public:
	explicit Polyline(double tolerance) : Direction(tolerance), atlas_(settings_) {}
	void trace(const std::vector<Ray>& rays, std::vector<Answer>& answers) override {
		for (std::size_t i = 0; i < rays.size(); i++) {
			Answer& a = answers[i];
			a.points = 1;
			if (route_.solve(rays[i].x, rays[i].d, atlas_, false)) {
				a.failed = false;
				a.captured = route_.outcome() == Outcome::captured;
				a.r = far;
				if (!a.captured)
					a.direction = route_.end_tangent();
				walk(route_, a);
				continue;
			}
			solve(rays[i], a);
			Chords chords(path_, settings_.tolerance, false);
			walk(chords, a);
		}
	}

private:
	template <typename Walk> void walk(Walk& chords, Answer& a) {
		Chord chord;
		while (chords.next(chord)) {
			sum_ = sum_ + chord.to; // every point is asked for
			a.points++;
		}
	}
	Atlas atlas_;
	Route route_;
	Vec3 sum_{0, 0, 0};
};

} // namespace

std::unique_ptr<Code> our_code(const std::string& name) {
	std::istringstream words(name);
	std::string kind;
	double tolerance = 0;
	words >> kind >> tolerance;
	if (kind == "escape")
		return std::make_unique<Closed>();
	if (kind == "path")
		return std::make_unique<Direction>(tolerance);
	if (kind == "nodes")
		return std::make_unique<Nodes>(tolerance);
	if (kind == "polyline")
		return std::make_unique<Polyline>(tolerance);
	return nullptr;
}

} // namespace bench
