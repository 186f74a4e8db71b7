// SPDX-License-Identifier: AGPL-3.0-or-later
/// Vectors of two and three doubles; nothing else.
#ifndef BLACKHOLE_VEC_H
#define BLACKHOLE_VEC_H

#include <cmath>

namespace blackhole {

struct Vec2 {
	double x, y;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double length(Vec2 a) { return std::sqrt(dot(a, a)); }

struct Vec3 {
	double x, y, z;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }

/// a times a power of two, so that its largest component is in [1/2, 1): without rounding, but for components 1e-308 of it.
inline Vec3 scaled(Vec3 a) {
	int e;
	std::frexp(std::fmax(std::fabs(a.x), std::fmax(std::fabs(a.y), std::fabs(a.z))), &e);
	return {std::ldexp(a.x, -e), std::ldexp(a.y, -e), std::ldexp(a.z, -e)};
}

/// a scaled to length 1, whatever its length; a zero vector stays zero.
inline Vec3 unit(Vec3 a) {
	double l = length(a);
	if (!(l > 1e-140 && l < 1e140)) { // squares near the ends of the exponent's range
		a = scaled(a);
		l = length(a);
	}
	return l > 0 ? (1 / l) * a : a;
}

} // namespace blackhole

#endif
