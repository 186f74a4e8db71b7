// SPDX-License-Identifier: AGPL-3.0-or-later
/// One ray's way inside the effect sphere, from where it starts to the sphere's surface or to the horizon.
#ifndef BLACKHOLE_PATH_H
#define BLACKHOLE_PATH_H

#include "blackhole/closed.h"
#include "blackhole/method.h"

#include <optional>
#include <vector>

namespace blackhole {

/// What decides how paths are computed; the same for all rays of a hole.
struct Settings {
	double effect_radius; ///< R in Rs, > 1.5
	double tolerance;     ///< radians, [1e-9, 0.1]
	Method method;
};

/// A place on a solved path: on the piece between two nodes, t in [0, 1].
struct Mark {
	std::size_t piece;
	double t;
};

/// A solved path. Reusable: solve() again keeps the memory. Not thread-safe; one for each thread.
class Path {
public:
	/// Traces a ray. x: position with |x| <= R (rounding beyond is harmless); d: coordinate direction, any length;
	/// with |x| = R it points inward. Inside the horizon d points outward with positive energy.
	/// The outcome is classify()'s. Returns false if no path of that outcome was found in the steps allowed:
	/// then the path is what was found last, and the caller counts and names the failure.
	bool solve(const Vec3& x, const Vec3& d, const Settings& settings);

	Outcome outcome() const { return outcome_; }
	/// Whether the ray started at or inside the horizon; then nothing can be hit before emerged().
	bool started_inside() const { return inside_; }
	/// The parameter s at which it left the horizon; 0 if it did not start inside, or fell back before it was out
	/// by as much as the tolerance can tell (started_inside() and captured).
	double emerged() const { return emerged_; }

	/// Nodes in order; at least two. The last lies on the effect sphere (escaped) or on the horizon (captured).
	const std::vector<Node>& nodes() const { return nodes_; }
	const Orbit& orbit() const { return orbit_; }

	/// u at a mark: by the closed form if the method is exact, else as the piece between the nodes has it.
	double u_at(const Mark& mark, const Piece& piece) const {
		if (!exact_)
			return piece.at(mark.t);
		const Node &from = nodes_[mark.piece], &to = nodes_[mark.piece + 1];
		// Far out its last digits may be all of u: never less than at the ends, or where rays turn inside the photon sphere.
		return std::fmax(exact_->at(orbit_.k * (from.s + mark.t * (to.s - from.s))).u,
			std::fmin(2.0 / 3, std::fmin(nodes_.front().u, nodes_.back().u)));
	}

	/// Where the path ends and the unit tangent there.
	Vec3 end() const {
		const Node& n = nodes_.back();
		return orbit_.point(n.u, std::cos(orbit_.k * n.s), std::sin(orbit_.k * n.s));
	}
	Vec3 end_tangent() const {
		const Node& n = nodes_.back();
		return unit(orbit_.velocity(n.u, n.w, std::cos(orbit_.k * n.s), std::sin(orbit_.k * n.s)));
	}

	/// Euclidean length, as the polyline through the nodes.
	double length() const;
	/// The unit tangent at a mark.
	Vec3 tangent(const Mark& mark) const;

	/// Angle swept around the hole's centre, radians, >= 0.
	double swept() const { return orbit_.k * nodes_.back().s; }
	/// The relative change of the energy, over the size of its terms, between start and end (the angular momentum cannot
	/// change in these variables): what the integrator did wrong, no more than a hint of the path's own error.
	double drift() const;
	/// Whether the path had to be taken a hair to the side of b_c for the numbers to follow classify(): only
	/// within 0.1 % of b_c, and for rays of next to no energy from deep inside the horizon.
	bool nudged() const { return nudged_; }
	/// Whether solve() returned false because the steps allowed (200,000) ran out: the tolerance is more than the method can do.
	/// No ray does that within the bounds of Settings (docs/stability.md).
	bool exhausted() const { return exhausted_; }

private:
	bool trace(const Settings& settings);
	bool trace_exactly(const Settings& settings);
	bool finish(const Node& last, double u);

	Orbit orbit_{{2, 0, 0}, {1, 0, 0}};
	std::vector<Node> nodes_;
	std::optional<Exact_Orbit> exact_; // only for Method::exact, and not for radial rays
	Outcome outcome_ = Outcome::escaped;
	bool inside_ = false, nudged_ = false, exhausted_ = false;
	double emerged_ = 0;
};

} // namespace blackhole

#endif
