// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/atlas.h"

#include "blackhole/chords.h"
#include "blackhole/turn.h"

#include <algorithm>

namespace blackhole {
namespace {

constexpr double narrowest = 0.02, widest = 1e5; // b; few rays are radial to this degree, and none bends that far out
constexpr double hem = 0.4; // to what u knots stand closer, and to half of what beyond infinity orbits are charted, about in 1/b
constexpr double per_radian = 3;
// The chords' part of the tolerance. Charted orbits are off by a few hundredths of it, an eighth at most, not by the half that
// chords.h allows.
constexpr double share = 0.75;
constexpr int most_knots = 2000;

// Rows are equally spaced in these. Near b_c an orbit changes with the logarithm of what is left.
double turning_coordinate(double b) { return std::log(b - critical_b); }
double turning_b(double x) { return critical_b + std::exp(x); }
double falling_coordinate(double b) { return std::log(b / (critical_b - b)); }
double falling_b(double x) { return critical_b / (1 + std::exp(-x)); }

// The root of r^3 = b^2 (r - 1) beyond 1.5, for b > b_c (Chandrasekhar, chapter 3, eq. 217): Newton from outside, where the
// cubic is convex.
double periastron(double b) {
	double r = b;
	for (int i = 0; i < 50; i++) {
		const double next = r - (r * r * r - b * b * (r - 1)) / (3 * r * r - b * b);
		if (!(next < r))
			break;
		r = next;
	}
	return r;
}

// Knots for each radian where u = 1 and nothing else counts.
double scale_of(double b, double tolerance) {
	const double chords = std::sqrt(1.5 * b / (8 * share * tolerance)), wide = per_radian * std::sqrt(1 + b * b);
	return std::sqrt(chords * chords + wide * wide);
}

Knot knot_of(double u, double v, double angle) {
	return Knot{
		static_cast<float>(u), static_cast<float>(v), static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

double density_at(double u, double b) {
	const double edge = hem / std::sqrt(1 + b * b);
	return std::sqrt((u * u + edge * edge) / std::sqrt(1 + b * b * u * u * u));
}

} // namespace

double Charted::slope(double u) const { return -std::sqrt(std::max(0.0, 1 - b_ * b_ * u * u * (1 - u))) / std::max(b_, 1.0); }

double Charted::density(double u) const { return scale_ * k_ * density_at(u, b_); }

int Charted::before(double u) const {
	// By the nearest row; the orbit itself differs by little.
	const Knot* row = first_ + (weight_[2] > weight_[1] ? 2 : 1);
	int lo = 0, hi = count_;
	while (lo + 1 < hi) {
		const int middle = (lo + hi) / 2;
		(row[middle * stride_][0] > u ? lo : hi) = middle;
	}
	while (lo + 1 < count_ && this->u(lo + 1) > u)
		lo++;
	while (lo > 0 && this->u(lo) < u)
		lo--;
	return lo;
}

double Charted::way(int from_knot, double u, double w) const {
	// How long it takes from one state to another that is near: by u where it changes, by w where that does, from the
	// two-point formula with derivatives up to the third (sixth order; the fourth was off by 1e-4 where knots are far apart).
	const Knot n = knot(from_knot);
	const double k2 = k_ * k_, near = n[0], a0 = acceleration(near, k2), a1 = acceleration(u, k2);
	const double from = n[1] / std::max(b_, 1.0), du = u - near, dw = w - from, W = 0.5 * (from + w), A = 0.5 * (a0 + a1),
				 both = W * W + A * A;
	const double j0 = k2 * (3 * near - 1) * from, j1 = k2 * (3 * u - 1) * w;
	const double q0 = k2 * ((3 * near - 1) * a0 + 3 * from * from), q1 = k2 * ((3 * u - 1) * a1 + 3 * w * w);
	const double da = (a1 - a0) / 10, dj = (j1 - j0) / 10, j = (j0 + j1) / 120, q = (q0 + q1) / 120;
	double s = (du * W + dw * A) / both;
	for (int i = 0; i < 3; i++)
		s = ((du + s * s * (da - s * j)) * W + (dw + s * s * (dj - s * q)) * A) / both;
	return std::max(0.0, s);
}

Atlas::Atlas(const Settings& settings) : settings_(settings) {
	if (settings.method == Method::exact || settings.tolerance < finest)
		return;
	const double R = settings.effect_radius, rim = std::min(widest, R / std::sqrt(1 - 1 / R));
	if (R > photon_sphere && rim > critical_b * (1 + band))
		chart(turning_, true, turning_coordinate(critical_b * (1 + band)), turning_coordinate(rim));
	chart(falling_, false, falling_coordinate(narrowest), falling_coordinate(critical_b * (1 - band)));
}

// Rows from and to are at or beyond the coordinates given, with one more at each side.
void Atlas::chart(Sheet& sheet, bool turning, double from, double to) {
	// A cubic's error is of fourth order.
	const double spacing = 0.18 * std::pow(settings_.tolerance, 0.25);
	// Never so few that a row beyond the rim has no three before it, from which its angle goes on.
	sheet.rows = std::max(2, static_cast<int>(std::ceil((to - from) / spacing))) + 4;
	sheet.step = (to - from) / (sheet.rows - 4);
	sheet.first = from - 1.5 * sheet.step;
	const Integrator& integrator = integrator_of(settings_.method);
	std::vector<std::vector<Knot>> all(sheet.rows);
	std::vector<std::vector<float>> angles(sheet.rows);
	std::size_t most = 0;
	const double edge = 1 / settings_.effect_radius;
	for (int i = 0; i < sheet.rows; i++) {
		const double x = sheet.first + i * sheet.step, b = turning ? turning_b(x) : falling_b(x);
		const Orbit orbit = turning ? Orbit({periastron(b), 0, 0}, {0, 1, 0}) : Orbit({1, 0, 0}, {1, b, 0});
		const double beta = std::max(b, 1.0), scale = scale_of(b, settings_.tolerance) * orbit.k,
					 end = -0.5 * hem / std::sqrt(1 + b * b);
		Plan plan = integrator.start(orbit, std::max(1e-9, 1e-3 * settings_.tolerance));
		Node from_node{0, orbit.u, orbit.w, acceleration(orbit.u, plan.k2)};
		std::vector<Knot>& row = all[i];
		row.push_back(knot_of(orbit.u, beta * orbit.w, 0));
		angles[i].push_back(0);
		double rim_angle = 0;
		for (double count = 0; from_node.u > end && row.size() < most_knots;) {
			const Node to_node = integrator.step(from_node, plan);
			const Piece piece(from_node, to_node);
			const double h = to_node.s - from_node.s;
			// N on the step by the parabola through its density at both ends and in the middle.
			const double d0 = density_at(from_node.u, b), dm = density_at(piece.at(0.5), b), d1 = density_at(to_node.u, b);
			const double c1 = scale * h * d0, c2 = scale * h * (4 * dm - 3 * d0 - d1) / 2,
						 c3 = scale * h * (2 * d0 - 4 * dm + 2 * d1) / 3;
			const double last = count + c1 + c2 + c3;
			while (static_cast<double>(row.size()) <= last) {
				const double left = static_cast<double>(row.size()) - count;
				double t = left / (c1 + c2 + c3);
				for (int n = 0; n < 4; n++)
					t -= (t * (c1 + t * (c2 + t * c3)) - left) / (c1 + t * (2 * c2 + t * 3 * c3));
				const double angle = orbit.k * (from_node.s + t * h);
				row.push_back(knot_of(piece.at(t), beta * piece.slope(t) / h, angle));
				angles[i].push_back(static_cast<float>(angle));
			}
			if (from_node.u > edge && to_node.u <= edge)
				rim_angle = orbit.k * (from_node.s + h * crossing(piece, edge));
			count = last;
			from_node = to_node;
		}
		most = std::max(most, row.size());
		// Beyond the rim there is no such angle; the cubic goes on.
		const std::vector<double>& t = sheet.through;
		const double speed = rim_speed(b);
		sheet.through.push_back(speed > 0 || i < 4 ? 2 * rim_angle / speed : 4 * (t[i - 1] + t[i - 3]) - 6 * t[i - 2] - t[i - 4]);
	}
	sheet.knots.assign(most * sheet.rows, Knot{-1, -1, 0, 0});
	sheet.angles.assign(most * sheet.rows, 0);
	for (int i = 0; i < sheet.rows; i++) {
		sheet.count.push_back(static_cast<int>(all[i].size()));
		for (std::size_t j = 0; j < all[i].size(); j++) {
			sheet.knots[j * sheet.rows + i] = all[i][j];
			sheet.angles[j * sheet.rows + i] = angles[i][j];
		}
	}
}

[[gnu::always_inline]] inline bool Atlas::locate(const Sheet& sheet, double b, int& row, double* weight) const {
	if (sheet.rows == 0 || std::fabs(b - critical_b) < band * critical_b || !(b >= narrowest && b <= widest))
		return false;
	const double x = ((b > critical_b ? turning_coordinate(b) : falling_coordinate(b)) - sheet.first) / sheet.step;
	if (!(x >= 1) || x >= sheet.rows - 2)
		return false;
	row = static_cast<int>(x) - 1;
	const double t = x - (row + 1), before = t + 1, after = 1 - t, beyond = 2 - t;
	weight[0] = -t * after * beyond / 6;
	weight[1] = before * after * beyond / 2;
	weight[2] = before * t * beyond / 2;
	weight[3] = -before * t * after / 6;
	return true;
}

bool Atlas::find(double b, Charted& orbit) const {
	const Sheet& sheet = b > critical_b ? turning_ : falling_;
	int i;
	if (!locate(sheet, b, i, orbit.weight_))
		return false;
	for (int n = 0; n < 4; n++) {
		const float w = static_cast<float>(orbit.weight_[n]);
		orbit.weights_[n] = Knot{w, w, w, w};
	}
	orbit.first_ = sheet.knots.data() + i;
	orbit.angle_ = sheet.angles.data() + i;
	orbit.through_ = sheet.through.data() + i;
	orbit.stride_ = sheet.rows;
	const int* n = sheet.count.data() + i;
	orbit.count_ = std::min(std::min(n[0], n[1]), std::min(n[2], n[3]));
	orbit.b_ = b;
	orbit.k_ = std::min(b, 1.0);
	orbit.scale_ = scale_of(b, settings_.tolerance);
	orbit.turns_ = b > critical_b;
	return true;
}

// dr/dlambda at the rim; 0 for a ray that passes it by.
double Atlas::rim_speed(double b) const {
	const double u = 1 / settings_.effect_radius;
	return std::sqrt(std::max(0.0, 1 - b * b * u * u * (1 - u)));
}

bool Atlas::through(const Vec3& x, const Vec3& d, Escape& out) const {
	const Vec3 axis = cross(x, d);
	const double R = settings_.effect_radius, s = dot(x, d), twist2 = dot(axis, axis);
	const double twist = std::sqrt(twist2), speed = 1 / std::sqrt(s * s + twist2 * ((R - 1) / R)), b = R * twist * speed;
	int i;
	double weight[4];
	if (!(b > critical_b) || !tells(s, twist2) || !locate(turning_, b, i, weight))
		return false;
	const double* row = turning_.through.data() + i;
	const double outward = -s * speed, across = b / R;
	out.phi = outward * (weight[0] * row[0] + weight[1] * row[1] + weight[2] * row[2] + weight[3] * row[3]);
	double c, t;
	turn_far(out.phi, c, t);
	// In x and d; e2, at right angles to x, is (R^2 d - s x) / (twist R).
	const double per_x = 1 / R, per_twist = 1 / twist, back = s * per_x * per_twist, on = R * per_twist;
	const double size = 1 / std::sqrt(outward * outward + across * across), p = size * outward, q = size * across;
	const double pc = p * c - q * t, pt = p * t + q * c;
	out.at = (c * per_x - t * back) * x + (t * on) * d;
	out.tangent = (pc * per_x - pt * back) * x + (pt * on) * d;
	return true;
}

std::size_t Atlas::bytes() const { return (turning_.knots.size() + falling_.knots.size()) * (sizeof(Knot) + sizeof(float)); }

} // namespace blackhole
