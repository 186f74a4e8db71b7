// SPDX-License-Identifier: AGPL-3.0-or-later
/// Orbits charted beforehand, so that a ray need not be followed: it lies between neighbours in impact parameter.
///
/// An orbit is fixed by its b alone; a ray is a part of it. Two sheets: orbits with b > b_c come from far away, turn at their
/// periastron and leave; those with b < b_c join the horizon to far away. Each is charted outward from that end, where the angle
/// and the count of knots begin; the other half of the first kind is its mirror image. Knots are laid as chords.h lays
/// chords, but for two terms: they stand a little closer where u is nearly zero, so that their places change smoothly with b up
/// to infinity, and at least thrice a radian or so where light hardly bends. Between charted b the knots are interpolated by
/// cubics.
///
/// Charted by the hole's own method, once, and shared by all threads: const member functions are thread-safe.
#ifndef BLACKHOLE_ATLAS_H
#define BLACKHOLE_ATLAS_H

#include "blackhole/four.h"
#include "blackhole/path.h"

#include <cstddef>
#include <vector>

namespace blackhole {

/// A point of a charted orbit: u; b du/dphi going outward (minus dr/dlambda at unit energy; unlike du/ds it is smooth in b);
/// cosine and sine of the angle. In single precision, 6e-8: a thousandth of the finest tolerance, and a line of cache
/// for four.
using Knot = Four;

/// The orbit of one impact parameter.
class Charted {
public:
	/// How many knots there are; the last ones lie beyond infinity (u < 0).
	int count() const { return count_; }
	double b() const { return b_; }
	double k() const { return k_; }
	/// Whether b > b_c.
	bool turns() const { return turns_; }
	double u(int j) const {
		const Knot* n = first_ + j * stride_;
		return weight_[0] * n[0][0] + weight_[1] * n[1][0] + weight_[2] * n[2][0] + weight_[3] * n[3][0];
	}
	Knot knot(int j) const {
		const Knot* n = first_ + j * stride_;
		return weights_[0] * n[0] + weights_[1] * n[1] + weights_[2] * n[2] + weights_[3] * n[3];
	}
	/// The angle of a knot, turns and all.
	double angle(int j) const {
		const float* n = angle_ + j * stride_;
		return weight_[0] * n[0] + weight_[1] * n[1] + weight_[2] * n[2] + weight_[3] * n[3];
	}
	/// du/ds going outward at u: <= 0.
	double slope(double u) const;
	/// The last knot no farther out than u; and the way from it to a u that is near (w: slope(u)).
	int before(double u) const;
	double way(int knot, double u, double w) const;
	/// The angle from the turning point to the effect sphere, whose speed is dr/dlambda there. turns() only.
	double to_rim(double speed) const {
		return 0.5 * speed *
			   (weight_[0] * through_[0] + weight_[1] * through_[1] + weight_[2] * through_[2] + weight_[3] * through_[3]);
	}
	/// dN/ds at u, N the count of knots.
	double density(double u) const;

private:
	friend class Atlas;
	const Knot* first_;
	const float* angle_;
	const double* through_;
	std::ptrdiff_t stride_;
	Knot weights_[4];
	double weight_[4], b_, k_, scale_;
	int count_;
	bool turns_;
};

class Atlas {
public:
	/// Charts what a hole of these settings needs: at most 16 MB. Tolerances below finest, and Method::exact, which is to be
	/// exact at every chord's end, are not charted.
	explicit Atlas(const Settings& settings);
	Atlas() = default;

	/// The orbit of this b. Returns false if it is not charted: radial, within band of b_c, or wider than the effect sphere.
	bool find(double b, Charted& orbit) const;

	/// The whole way of a ray that enters the effect sphere from outside, at x with |x| = R, where all that matters is how it
	/// leaves. Returns false, out unchanged, where the atlas does not have it, or it is captured.
	bool through(const Vec3& x, const Vec3& d, Escape& out) const;

	/// Whether double precision tells a ray's b, of x.d and |x cross d|^2: not from 1e7 b away, nor of d far from unit length.
	/// (Its last digits there are 1e-9 of b, and 5e-7 of the way, which grows 500-fold at the edge of the band.)
	static bool tells(double along, double twist2) { return twist2 > 1e-14 * along * along && twist2 > 1e-200 && twist2 < 1e200; }

	const Settings& settings() const { return settings_; }
	std::size_t bytes() const;

	static constexpr double finest = 5e-5;
	/// Nearer to b_c, as a share of it, neighbours differ too much.
	static constexpr double band = 2e-3;

private:
	struct Sheet {
		double first = 0, step = 1; // of the rows, in the sheet's own coordinate
		int rows = 0;
		std::vector<int> count;
		std::vector<Knot> knots; // knot j of row i at j * rows + i
		std::vector<float> angles;
		std::vector<double> through; // of row i: the angle from rim to rim over dr/dlambda there; smooth where both vanish
	};
	/// Of b on the sheet: the first of four rows, and their weights.
	bool locate(const Sheet& sheet, double b, int& row, double* weight) const;
	double rim_speed(double b) const;
	void chart(Sheet& sheet, bool turning, double from, double to);

	Settings settings_{0, 0, Method::exact};
	Sheet turning_, falling_;
};

} // namespace blackhole

#endif
