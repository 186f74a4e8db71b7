// SPDX-License-Identifier: AGPL-3.0-or-later
/// What bench/rays measures: several codes on the same rays.
#ifndef BENCH_RAYS_H
#define BENCH_RAYS_H

#include "blackhole/vec.h"

#include <memory>
#include <string>
#include <vector>

namespace bench {

using blackhole::Vec3;

constexpr double far = 500; ///< Rs: where rays that escape end

/// One ray, as each code takes it. Made before any clock runs.
struct Ray {
	Vec3 x, d;      ///< ours: position and coordinate direction
	double four[8]; ///< GYOTO's: position and velocity of the photon that arrives, Boyer-Lindquist, M = 1
	double time;    ///< M: when that photon passed 500 Rs, or long ago: no code follows it farther
	bool captured;  ///< the exact answer, and
	Vec3 direction; ///< the direction at 500 Rs
	double b;       ///< impact parameter
};

/// What a code says of a ray.
struct Answer {
	bool captured, failed;
	double r;       ///< Rs: where it has
	Vec3 direction; ///< this unit direction
	unsigned points;
};

/// A code at one setting.
class Code {
public:
	virtual ~Code() = default;
	virtual void trace(const std::vector<Ray>& rays, std::vector<Answer>& answers) = 0;
};

/// "escape", "path TOLERANCE", "nodes TOLERANCE", "polyline TOLERANCE"; nullptr for other names.
std::unique_ptr<Code> our_code(const std::string& name);
/// "gyoto INTEGRATOR TOLERANCE STEP", "gyoto-points ..." of the same words; STEP is the first step, M.
std::unique_ptr<Code> gyoto_code(const std::string& name);

/// Loads GYOTO; then photons' four[] and time can be found, from x and the direction n that a static observer sees.
void gyoto_start();
void gyoto_ray(Ray& ray, double r, double theta, double phi, const double n[3]);
void gyoto_times(std::vector<Ray>& rays);

} // namespace bench

#endif
