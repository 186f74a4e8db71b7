// SPDX-License-Identifier: AGPL-3.0-or-later
/// What bench/trade measures: pictures as rays, what each pixel shows, and what it should show.
///
/// Lengths in Rs, the hole at the origin; places and directions as in blackhole/orbit.h. A scene has no bounds but one
/// plane or none: what lies beside it is the sky, at infinity.
#ifndef BENCH_TRADE_H
#define BENCH_TRADE_H

#include "blackhole/chords.h"
#include "blackhole/closed.h"

#include <memory>
#include <string>
#include <vector>

namespace trade {

using blackhole::Vec3;

/// A flat ring, from inner to outer about its centre.
struct Plane {
	Vec3 centre, normal; ///< normal: unit
	double inner, outer;
	bool mirror; ///< shows what it reflects, once
	double side(const Vec3& p) const { return dot(normal, p - centre); }
	bool holds(const Vec3& p) const {
		const double r = length(p - centre);
		return r >= inner && r <= outer;
	}
};

/// A picture of 1920 x 1080 square pixels by a static pinhole camera.
struct Scene {
	const char *name, *what;
	Vec3 eye, right, up, ahead; ///< units, but for eye
	double pixel;               ///< width of a pixel at the middle of the picture, radians
	bool has_plane;
	Plane plane;

	/// The direction that the observer at eye sees at a place on the picture, pixels from its middle; unit.
	Vec3 direction(double x, double y) const { return unit(ahead + (x * pixel) * right + (y * pixel) * up); }
};

constexpr double width = 1920, height = 1080;

std::vector<Scene> scenes();

/// What a pixel shows.
struct Seen {
	enum Kind { black, sky, object } kind = black;
	bool mirrored = false; ///< by way of the mirror
	unsigned crossing = 0; ///< for an object: the how manieth time its plane was met
	Vec3 what{0, 0, 0};    ///< the sky's unit direction, or the object's place
	Vec3 along{0, 0, 0};   ///< exact answers of an object: the unit tangent there
	double beside = 1;     ///< exact answers: the least |b/b_c - 1| on the way
	bool same(const Seen& s) const { return kind == s.kind && mirrored == s.mirrored && crossing == s.crossing; }
};

/// A way to trace rays, at one setting. Not thread-safe.
class Tracer {
public:
	virtual ~Tracer() = default;
	/// d: as the observer at the scene's eye sees it.
	Seen trace(const Scene& scene, const Vec3& d);

protected:
	explicit Tracer(double R) : R_(R) {}
	/// From x inside the effect sphere along the coordinate direction d. On a hit (plane may be NULL) seen.kind is object, x the
	/// place and d the tangent there; captured: black; else sky, with x and d as the ray leaves the sphere.
	virtual void bend(Vec3& x, Vec3& d, const Plane* plane, bool camera, Seen& seen) = 0;
	double R_;

private:
	bool straight(Vec3& x, const Vec3& d, double most, const Plane* plane, Seen& seen) const;
};

/// method: "rk4", "dopri5", "exact", in chords as pictures have them; "sky", the closed form alone, which pictures without
/// objects use; "euler", steps of that length, and "euler-r", steps of that part of r, as programs of the 1990s.
/// setting: tolerance or step.
std::unique_ptr<Tracer> tracer(const std::string& method, double setting, double R);

/// What is there to see without an effect radius, in closed form.
Seen exact(const Scene& scene, const Vec3& d);
/// The largest difference in what is seen from the same by quadrature (tests/blackhole/oracle), at each so manieth pixel
/// of a grid; more than 1e-9 is a mistake.
double witness(const Scene& scene, int across);

/// A pixel with its exact answer.
class Pixel {
public:
	Pixel(const Scene& scene, double x, double y);
	Vec3 direction() const { return scene_->direction(x_, y_); }
	const Seen& truth() const { return truth_; }
	/// How far away on the picture, in pixels, what was seen is to be seen in truth: the difference over the exact picture's own
	/// derivative. Where something else was seen than should be: how far to the nearest pixel that shows that.
	double shift(const Seen& seen) const;
	/// The error of the sky's direction, or the distance of a hit from the exact path over r; radians. Of the same thing only.
	double angle(const Seen& seen) const;

private:
	void differentiate();
	bool step(const Seen& seen, double& dx, double& dy) const;
	double nearest(const Seen& seen) const;
	const Scene* scene_;
	double x_, y_;
	Seen truth_;
	double cosine_ = 1, sine_ = 0;               // on the picture, of the way away from the hole
	Vec3 by_away_{0, 0, 0}, by_across_{0, 0, 0}; // of truth_.what, for each pixel that way and across
};

} // namespace trade

#endif
