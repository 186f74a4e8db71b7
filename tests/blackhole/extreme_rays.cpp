// SPDX-License-Identifier: AGPL-3.0-or-later
#include "extremes.h"

#include <algorithm>

using namespace blackhole;

namespace extremes {

const char* const kind_names[kinds] = {"anywhere", "radial", "at the edge", "photon sphere", "effect sphere", "horizon", "inside",
	"small sphere", "critical", "tangential"};

namespace {

using Random = std::mt19937_64;

double uniform(Random& random) { return std::uniform_real_distribution<double>(0, 1)(random); }
double log_uniform(Random& random, double lo, double hi) { return lo * std::pow(hi / lo, uniform(random)); }
int pick(Random& random, int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); }
double ulps(double a, int n) {
	for (; n > 0; n--)
		a = std::nextafter(a, 1e300);
	for (; n < 0; n++)
		a = std::nextafter(a, -1e300);
	return a;
}

// Cosine of the critical angle off the outward radial.
double critical_cosine(double r) { return (1.5 - r) * std::sqrt((r + 3) / (r * r * r + 6.75)); }

// From 0.1 to 1e-9, the narrow ones seldom: they take a thousand times as long, and rays that wind ten times that.
double any_tolerance(Random& random, bool winds) {
	const double k = (winds ? 8 : 1) * uniform(random);
	if (k > 1)
		return log_uniform(random, 1e-2, 0.1);
	if (k < 0.0003)
		return k < 0.0001 ? 1e-9 : log_uniform(random, 1e-9, 1e-6);
	if (k < 0.05)
		return log_uniform(random, 1e-6, 1e-4);
	return k < 0.1 ? 0.1 : log_uniform(random, 1e-4, 0.1);
}

} // namespace

Ray generate(Kind kind, Random& random) {
	const double to_the_horizon[] = {1e-15, 1e-12, 1e-8, 1e-4, 0.1, 1};
	double r = 1 + to_the_horizon[pick(random, 6)] * log_uniform(random, 1, 1e12) * (pick(random, 2) ? 1 : uniform(random));
	r = std::min(r, 1e12);
	double cosine = 2 * uniform(random) - 1, sine = -1; // of the angle off the outward radial
	double R = r * (1 + (pick(random, 3) ? log_uniform(random, 1e-12, 1e3) : 0));
	switch (kind) {
	case anywhere:
		if (pick(random, 2) && r > 10) { // aimed at the hole
			sine = std::min(1.0, 8 * uniform(random) / r);
			cosine = -std::sqrt(1 - sine * sine);
		}
		break;
	case radial:
		cosine = pick(random, 2) ? 1 : -1;
		sine = pick(random, 3) ? 0 : log_uniform(random, 1e-320, 1e-7);
		break;
	case at_the_edge:
		r = pick(random, 2) ? r : 1 + log_uniform(random, 1e-8, 100);
		cosine = critical_cosine(r);
		sine = ulps(std::sqrt(1 - cosine * cosine), pick(random, 41) - 20);
		cosine = ulps(cosine, pick(random, 41) - 20);
		break;
	case photon_sphere: {
		r = pick(random, 3) ? ulps(1.5, pick(random, 9) - 4)
							: 1.5 * (1 + log_uniform(random, 1e-15, 1e-3) * (pick(random, 2) ? 1 : -1));
		const double small = log_uniform(random, 1e-320, 1e-1);
		const double at[] = {0, small, -small, cosine};
		cosine = at[pick(random, 4)];
		break;
	}
	case effect_sphere:
		R = r = std::max(r, 1.5000001);
		cosine = pick(random, 2) ? -std::fabs(cosine) : -log_uniform(random, 1e-320, 1);
		break;
	case horizon:
		r = ulps(1, pick(random, 21) - 10);
		cosine = pick(random, 3) ? cosine : pick(random, 2) ? log_uniform(random, 1e-20, 1) : 1;
		break;
	case inside:
		r = 1 - (pick(random, 2) ? log_uniform(random, 1e-16, 1e-8) : log_uniform(random, 1e-8, 0.999));
		sine = std::sqrt(r) * (pick(random, 2) ? uniform(random) : 1 - log_uniform(random, 1e-15, 1));
		cosine = std::sqrt(1 - sine * sine);
		break;
	case small_sphere:
		R = 1.5 * (1 + log_uniform(random, 2e-16, 1e-6));
		R = pick(random, 2) ? 1.5000001 : std::max(R, ulps(1.5, 1));
		r = pick(random, 2) ? R : 1 + (R - 1) * uniform(random);
		cosine = pick(random, 2) ? cosine : cosine * log_uniform(random, 1e-17, 1);
		break;
	case critical: { // five turns round the photon sphere: |b / b_c - 1| about 1e-13
		r = pick(random, 2) ? 1.0001 + 0.4998 * uniform(random) : log_uniform(random, 1.5001, 1e6);
		const double off = pick(random, 3) ? log_uniform(random, 1e-15, 1e-11) : log_uniform(random, 1e-15, 1e-2);
		const double b = critical_b * (1 + (pick(random, 2) ? off : -off));
		sine = std::min(1.0, b / r / std::sqrt(1 + b * b / (r * r * r)));
		cosine = std::sqrt(1 - sine * sine) * (r > 1.5 ? -1 : 1);
		break;
	}
	default:
		cosine = pick(random, 2) ? 0 : (pick(random, 2) ? 1 : -1) * log_uniform(random, 1e-320, 1e-7);
	}
	if (sine < 0)
		sine = std::sqrt((1 - cosine) * (1 + cosine));
	if (kind != effect_sphere && kind != small_sphere)
		R = std::max(pick(random, 3) ? R : 1000, r);
	R = std::max(R, ulps(1.5, 1));

	Ray ray;
	const Method methods[] = {Method::rk4, Method::rk4, Method::dopri5, Method::exact};
	ray.settings = {
		R, any_tolerance(random, kind == at_the_edge || kind == critical || kind == photon_sphere), methods[pick(random, 4)]};
	ray.ramp = pick(random, 4) == 0;
	if (pick(random, 2)) { // on an axis, to the last bit
		ray.x = {r, 0, 0};
		ray.d = {cosine, sine, 0};
	} else {
		std::normal_distribution<double> n;
		const Vec3 e = unit({n(random), n(random), n(random)}), t = unit(cross(e, {n(random), n(random), n(random)}));
		ray.x = r * e;
		ray.d = cosine * e + sine * t;
	}
	const double lengths[] = {1, 1, 1, 1, 1e-310, 1e300, 1e-200, 1e100, 0.3, 1e-30};
	ray.d = lengths[pick(random, 10)] * ray.d;
	return ray;
}

} // namespace extremes
