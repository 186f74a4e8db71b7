// SPDX-License-Identifier: AGPL-3.0-or-later
/// GYOTO's side of bench/rays: Metric::KerrBL without spin and Photon's integration, as Debian built them.
///
/// Without an Astrobj, whose DeltaMaxInsideRMax of 1 M makes GYOTO crawl, the tolerances alone set the steps. Each photon is
/// given the time at which it passes 500 Rs, found beforehand, so that none is followed farther than the step that gets there.
#define GYOTO_NO_DEPRECATED
#include "rays.h"

#include <GyotoAstrobj.h>
#include <GyotoMetric.h>
#include <GyotoPhoton.h>
#include <GyotoRegister.h>
#include <GyotoUtils.h>
#include <GyotoValue.h>

#include <cmath>
#include <sstream>

namespace bench {
namespace {

using namespace Gyoto;

SmartPointer<Metric::Generic> metric;

SmartPointer<Photon> photon(const std::string& integrator, double tolerance, double step) {
	SmartPointer<Photon> p = new Photon();
	p->metric(metric);
	p->integrator(integrator);
	p->absTol(tolerance);
	p->relTol(tolerance);
	p->delta(step);
	p->maxiter(100000000);
	return p;
}

/// Where light came from, on flat axes, at a point of its way.
Vec3 direction(const state_t& c) {
	const double st = std::sin(c[2]), ct = std::cos(c[2]), sp = std::sin(c[3]), cp = std::cos(c[3]);
	const double v[3] = {c[5], c[1] * c[6], c[1] * st * c[7]};
	return unit(Vec3{-(v[0] * st * cp + v[1] * ct * cp - v[2] * sp), -(v[0] * st * sp + v[1] * ct * sp + v[2] * cp),
		-(v[0] * ct - v[1] * st)});
}

class Photons : public Code {
public:
	Photons(const std::string& integrator, double tolerance, double step, bool points)
		: photon_(photon(integrator, tolerance, step)), points_(points) {}
	void trace(const std::vector<Ray>& rays, std::vector<Answer>& answers) override {
		state_t end;
		for (std::size_t i = 0; i < rays.size(); i++) {
			Answer& a = answers[i];
			photon_->setInitialCondition(metric, SmartPointer<Astrobj::Generic>(nullptr), rays[i].four);
			photon_->xFill(rays[i].time);
			const std::size_t first = photon_->getImin(), last = photon_->getImax();
			photon_->getCoord(first, end);
			a.captured = end[1] < 2.1; // KerrBL stops at 2.01
			a.failed = !a.captured && end[1] < 1.999 * far;
			a.r = end[1] / 2;
			if (!a.captured)
				a.direction = direction(end);
			a.points = static_cast<unsigned>(last - first + 1);
			if (points_) {
				double p[4];
				for (std::size_t j = first; j <= last; j++) {
					photon_->getCartesianPos(j, p);
					sum_ += p[1] + p[2] + p[3]; // every point is asked for
				}
			}
		}
	}

private:
	SmartPointer<Photon> photon_;
	bool points_;
	double sum_ = 0;
};

} // namespace

void gyoto_start() {
	Gyoto::verbose(0);
	Register::init("stdplug");
	std::vector<std::string> plugins{"stdplug"};
	metric = (*Metric::getSubcontractor("KerrBL", plugins, 0))(nullptr, plugins);
	metric->set("Spin", Value(0.));
}

// n: what the static observer sees along e_r, e_theta, e_phi. The photon that arrives goes the other way; its energy there is 1.
void gyoto_ray(Ray& ray, double r, double theta, double phi, const double n[3]) {
	const double root = std::sqrt(1 - 1 / r), m = 2 * r;
	const double four[8] = {0, m, theta, phi, 1 / root, -root * n[0], -n[1] / m, -n[2] / (m * std::sin(theta))};
	for (int i = 0; i < 8; i++)
		ray.four[i] = four[i];
}

void gyoto_times(std::vector<Ray>& rays) {
	SmartPointer<Photon> p = photon("runge_kutta_fehlberg78", 1e-9, 0.01);
	for (Ray& ray : rays) {
		ray.time = -4 * far;
		p->setInitialCondition(metric, SmartPointer<Astrobj::Generic>(nullptr), ray.four);
		p->xFill(ray.time);
		state_t c, before;
		for (std::size_t i = p->getI0(); i > p->getImin(); i--) {
			p->getCoord(i, before);
			p->getCoord(i - 1, c);
			if (c[1] >= 2 * far) { // out here r and t go alike
				ray.time = before[0] + (c[0] - before[0]) * (2 * far - before[1]) / (c[1] - before[1]);
				break;
			}
		}
	}
}

std::unique_ptr<Code> gyoto_code(const std::string& name) {
	std::istringstream words(name);
	std::string kind, integrator;
	double tolerance = 0, step = 0;
	words >> kind >> integrator >> tolerance >> step;
	if (kind != "gyoto" && kind != "gyoto-points")
		return nullptr;
	return std::make_unique<Photons>("runge_kutta_" + integrator, tolerance, step, kind == "gyoto-points");
}

} // namespace bench
