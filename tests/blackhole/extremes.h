// SPDX-License-Identifier: AGPL-3.0-or-later
/// Rays at the extremes of what the library's headers allow, and what must hold for every ray they allow.
///
/// Shared by extremes_test.cpp (a million rays), extremes_long.cpp (as many as there is time for) and fuzz.cpp.
#ifndef TESTS_EXTREMES_H
#define TESTS_EXTREMES_H

#include "blackhole/chords.h"
#include "blackhole/closed.h"
#include "blackhole/route.h"

#include <istream>
#include <random>
#include <string>

namespace extremes {

struct Ray {
	blackhole::Vec3 x, d;
	blackhole::Settings settings;
	bool ramp = false;
	std::string text() const; ///< the doubles to the last bit, as C++ has them
};

/// The kinds of rays that generate() makes.
enum Kind {
	anywhere,
	radial,
	at_the_edge,
	photon_sphere,
	effect_sphere,
	horizon,
	inside,
	small_sphere,
	critical,
	tangential,
	kinds
};
extern const char* const kind_names[kinds];
/// printf's.
std::string words(const char* format, ...);

/// A ray of that kind; not every one is allowed().
Ray generate(Kind kind, std::mt19937_64& random);

/// Whether the headers allow the ray: 0 < |x| <= R (to rounding), d not zero, and from the horizon inward d outward with
/// positive energy. About the doubles as given, in quadruple precision.
bool allowed(const Ray& ray);

/// The outcome about the doubles as given, in quadruple precision: the barrier's height against
/// the ray's and the side of the photon sphere, not classify()'s formula. margin: how near it was, as the share of what was
/// compared.
blackhole::Outcome witness(const Ray& ray, double& margin);

/// The largest, over all rays, of what a ray can be judged by; for the reader.
struct Figures {
	long rays = 0, captured = 0, near = 0, nudged = 0, oracle = 0, back = 0;
	long turned = 0; ///< five turns or more
	long nodes = 0, chords = 0;
	long most_nodes = 0, most_chords = 0;
	double drift = 0;     ///< over the tolerance, outside the 0.1 % band; likewise the next three
	double off = 0;       ///< chord points' distance from the exact curve, over tolerance * r
	double direction = 0; ///< at the exit, over the tolerance
	double back_off = 0;  ///< where the path followed back from its exit passes the start, over tolerance * r
	double swept = 0;     ///< radians, of any ray
	double steps = 0;     ///< over the bound, of paths of more than ten nodes
	double closest = 1;   ///< smallest margin of witness() but 0
	void add(const Figures& other);
	/// As numbers in a line, and back.
	std::string line() const;
	bool read(std::istream& in);
	void print(const char* name) const;
};

/// Perpendicular distance from the exact curve of a point in the orbit's plane, at radius r after the angle phi, over r.
double distance(const blackhole::Exact_Orbit& exact, double phi, double r);

/// What must hold of every allowed ray. Returns what does not, or an empty string. exact: compares with the closed form,
/// and follows the path back, too.
std::string check(const Ray& ray, bool exact, blackhole::Path& path, Figures& figures);

/// As Figures, of rays by an atlas; the doubles over the tolerance.
struct Charted_Figures {
	long rays = 0, charted = 0, through = 0, chords = 0;
	double direction = 0, place = 0, off = 0, drift = 0;
	void add(const Charted_Figures& other);
	/// As those of Figures.
	std::string line() const;
	bool read(std::istream& in);
	void print(const char* name) const;
};

/// A ray of a Kind for an atlas of these settings, or of the kind after the last: aimed from the effect sphere at the hole, b to
/// 20 Rs. entering: one from beyond the sphere is put on it. Returns false if it is not allowed().
bool generate(int kind, const blackhole::Settings& settings, bool entering, std::mt19937_64& random, Ray& ray);

/// What must hold of an allowed ray where the atlas has it: what it may not know it must leave to a path. As check() above.
std::string check(const Ray& ray, const blackhole::Atlas& atlas, Charted_Figures& worst);

} // namespace extremes

#endif
