// SPDX-License-Identifier: AGPL-3.0-or-later
/// The ways to travel in blackhole.inc, against Hamilton's equations integrated by Runge-Kutta. No solved orbit is used: what is
/// put in is the metric, in Painleve's coordinates, which go on through the horizon; forces are differences, starts are searched
/// for.
#include "povray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace {

// Painleve's time, the radius, the longitude and the radial momentum of a body.
struct State {
	double time, r, phi, p_r;
};

State operator+(const State& a, const State& b) { return {a.time + b.time, a.r + b.r, a.phi + b.phi, a.p_r + b.p_r}; }
State operator*(double h, const State& a) { return {h * a.time, h * a.r, h * a.phi, h * a.p_r}; }

struct Body {
	double rs, energy, momentum;

	// g^ab p_a p_b / 2 for ds^2 = -dT^2 + (dr + sqrt(rs/r) dT)^2 + r^2 dphi^2: -1/2 for a body with a watch, 0 for light.
	double hamiltonian(double r, double p_r) const {
		const double beta = std::sqrt(rs / r);
		return (-energy * energy - 2 * beta * energy * p_r + (1 - rs / r) * p_r * p_r + momentum * momentum / (r * r)) / 2;
	}
	double force(double r, double p_r) const {
		const double h = 1e-3 * r;
		return (8 * (hamiltonian(r - h, p_r) - hamiltonian(r + h, p_r)) - hamiltonian(r - 2 * h, p_r) +
				   hamiltonian(r + 2 * h, p_r)) /
			   (12 * h);
	}
	State rate(const State& s) const {
		const double beta = std::sqrt(rs / s.r);
		return {energy + beta * s.p_r, (1 - rs / s.r) * s.p_r - beta * energy, momentum / (s.r * s.r), force(s.r, s.p_r)};
	}
	State after(State s, double time, int steps) const {
		const double h = time / steps;
		for (int i = 0; i < steps; i++) {
			const State k1 = rate(s), k2 = rate(s + h / 2 * k1), k3 = rate(s + h / 2 * k2), k4 = rate(s + h * k3);
			s = s + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
		}
		return s;
	}
	// The radial momentum of what neither rises nor falls.
	double level(double r) const { return std::sqrt(rs / r) * energy / (1 - rs / r); }
};

template <class Function> double root(Function f, double a, double b) {
	const bool sign = f(a) > 0;
	for (int i = 0; i < 100; i++) {
		const double middle = (a + b) / 2;
		((f(middle) > 0) == sign ? a : b) = middle;
	}
	return a;
}

// The one at r with this momentum that neither rises nor falls at this moment; twice_h is 2 H.
Body level_at(double rs, double r, double momentum, double twice_h) {
	const double energy = root(
		[&](double e) {
			const Body b{rs, e, momentum};
			return 2 * b.hamiltonian(r, b.level(r)) - twice_h;
		},
		0, 1e3);
	return {rs, energy, momentum};
}

// The one that stays at r: no force on it either.
Body circling(double rs, double r) {
	return level_at(rs, r,
		root(
			[&](double l) {
				const Body b = level_at(rs, r, l, -1);
				return b.force(r, b.level(r));
			},
			1e-3 * rs, 50 * rs),
		-1);
}

// What a piece of scene language prints by Say(number) and Place(vector).
std::vector<double> ask(const std::string& what) {
	const Rendering run = povray("#include \"blackhole.inc\"\n#fopen F \"numbers.txt\" write\n"
								 "#macro Say (A) #write(F, str(A, 0, 15), \"\\n\") #end\n"
								 "#macro Place (V) #local P = V; Say(P.x) Say(P.y) Say(P.z) #end\n" +
									 what + "\n#fclose F camera { location <0, 0, -9> }",
		4, 3);
	EXPECT_EQ(run.exit_code, 0) << run.text;
	std::ifstream in(run.folder + "/numbers.txt");
	std::vector<double> out;
	for (double a; in >> a;)
		out.push_back(a);
	return out;
}

std::string call(const std::string& name, const std::vector<double>& values) {
	std::string out;
	for (double v : values)
		out += (out.empty() ? "" : ", ") + number(v);
	return name + "(" + out + ")";
}

// It starts at -z and goes towards +x.
void expect_place(const double* place, double r, double phi, double tolerance, const std::string& what) {
	EXPECT_NEAR(place[0], r * std::sin(phi), tolerance) << what;
	EXPECT_EQ(place[1], 0) << what;
	EXPECT_NEAR(place[2], -r * std::cos(phi), tolerance) << what;
}

} // namespace

TEST(Travel, FallsByTheFallersWatch) {
	for (const double rs : {1.0, 0.4}) {
		const double from = 7 * rs, to = 0.3 * rs;
		std::string scene = "Say(" + call("Blackhole_Fall_Time", {rs, from, to}) + ")";
		for (int i = 0; i <= 8; i++)
			scene += " Place(" + call("Blackhole_Fall", {rs, from, to, i / 8.0}) + ")";
		const std::vector<double> said = ask(scene);
		ASSERT_EQ(said.size(), 1U + 9 * 3);
		// From rest at infinity: the energy is 1, and of the two ways at 2 H = -1 the one that goes in.
		const Body body{rs, 1, 0};
		State s{0, from, 0, root([&](double p) { return body.hamiltonian(from, p) + 0.5; }, -0.5, 0.5)};
		for (std::size_t i = 0; i <= 8; i++) {
			expect_place(&said[1 + 3 * i], s.r, 0, 1e-8 * rs, "Rs " + number(rs) + ", step " + std::to_string(i));
			if (i < 8)
				s = body.after(s, said[0] / 8, 4000);
		}
		EXPECT_LT(s.r, 0.31 * rs);
	}
}

TEST(Travel, OrbitsByTheTravellersWatchAndByTheFarClock) {
	const double rs = 2.5;
	std::string scene;
	std::vector<State> states; // with the traveller's time of a turn for p_r, which is of no more use
	for (const double r : {1.8 * rs, 3 * rs, 10 * rs})
		for (const double part : {0.1, 0.45}) {
			const Body body = circling(rs, r);
			const State start{0, r, 0, body.level(r)};
			const double once = 2 * std::acos(-1) / body.rate(start).phi;
			State s = body.after(start, part * once, 4000);
			EXPECT_NEAR(s.r, r, 1e-6 * r) << "the test's own orbit";
			s.r = r;
			s.p_r = once;
			states.push_back(s);
			scene += "Place(" + call("Blackhole_Orbit", {rs, r, part * once}) + ") Place(" +
					 call("Blackhole_Orbit_Far", {rs, r, s.time}) + ") Say(" + call("Blackhole_Orbit_Period", {rs, r}) +
					 ") Say(" + call("Blackhole_Orbit_Period_Far", {rs, r}) + ")\n";
		}
	const std::vector<double> said = ask(scene);
	ASSERT_EQ(said.size(), 8 * states.size());
	for (std::size_t i = 0; i < states.size(); i++) {
		const State& s = states[i];
		expect_place(&said[8 * i], s.r, s.phi, 1e-6 * s.r, "by the traveller's watch, r " + number(s.r));
		expect_place(&said[8 * i + 3], s.r, s.phi, 1e-6 * s.r, "by the far clock, r " + number(s.r));
		EXPECT_NEAR(said[8 * i + 6], s.p_r, 1e-6 * s.p_r) << s.r;
		EXPECT_NEAR(said[8 * i + 7], 2 * std::acos(-1) / s.phi * s.time, 1e-6 * said[8 * i + 7]) << s.r;
	}
}

// Light: where it circles is searched for too.
TEST(Travel, PhotonsCircleByTheFarClock) {
	for (const double rs : {1.0, 0.3}) {
		const double r = root(
			[&](double at) {
				const Body b = level_at(rs, at, rs, 0);
				return b.force(at, b.level(at));
			},
			1.1 * rs, 4 * rs);
		const Body light = level_at(rs, r, rs, 0);
		const State start{0, r, 0, light.level(r)}, s = light.after(start, r * r / rs, 4000);
		const std::vector<double> said = ask(
			"Place(" + call("Blackhole_Photon_Circle", {rs, s.time}) + ") Say(" + call("Blackhole_Photon_Period", {rs}) + ")");
		ASSERT_EQ(said.size(), 4U);
		EXPECT_GT(s.phi, 0.9);
		expect_place(&said[0], r, s.phi, 1e-6 * rs, "Rs " + number(rs));
		EXPECT_NEAR(said[3], 2 * std::acos(-1) / s.phi * s.time, 1e-6 * rs);
	}
}
