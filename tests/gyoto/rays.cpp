// SPDX-License-Identifier: AGPL-3.0-or-later
// What GYOTO (https://gyoto.obspm.fr) sees through a pinhole camera beside a Schwarzschild black hole.
//
//   rays r theta phi left right bottom top pixels tolerance
//
// GYOTO's units: M = 1, so Rs = 2. The observer rests at Boyer-Lindquist (r, theta, phi) and looks at the hole; left,
// right, bottom, top are where the picture's edges cut a plane at distance 1 (the tangents of pinhole cameras).
//
// Everything physical is GYOTO's: Metric::KerrBL with spin 0, Screen's rectilinear projection with the observer kind
// ZAMO (without spin: the static observer; "ObserverAtInfinity", the default, is another frame and wrong this near),
// Photon's integration. This program shares nothing with ours, and only turns the last point into a direction.
//
// One line for each pixel, row by row from the top left: 1 if the photon came from the hole, 0 if from far away; impact
// parameter over the critical one; the direction it came from on flat axes (x = r sin theta cos phi, ...) or 0 0 0; the
// direction seen, along (e_phi, -e_theta, -e_r): right, up, forward; drift of the impact parameter along the way.
#define GYOTO_NO_DEPRECATED
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <GyotoAstrobj.h>
#include <GyotoError.h>
#include <GyotoMetric.h>
#include <GyotoPhoton.h>
#include <GyotoRegister.h>
#include <GyotoScreen.h>
#include <GyotoUtils.h>
#include <GyotoValue.h>

using namespace Gyoto;

namespace {

const double far = 2000;       // M: the effect radius compared with, 1000 Rs. Beyond it 1e-8 rad of bending is left at most.
const double long_ago = -6000; // M: by then every photon that came from far away was beyond `far`.

/// L/E over 3 sqrt(3) M, with GYOTO's metric.
double impact(const Metric::Generic& metric, const double* c) {
	double g[4][4];
	metric.gmunu(g, c);
	const double energy = -g[0][0] * c[4];
	const double momentum = std::sqrt(g[2][2]) * std::hypot(std::sqrt(g[2][2]) * c[6], std::sqrt(g[3][3]) * c[7]);
	return momentum / energy / (3 * std::sqrt(3));
}

int run(char** argument) {
	double value[10];
	for (int i = 1; i <= 9; i++)
		value[i] = std::atof(argument[i]);
	const double left = value[4], right = value[5], bottom = value[6], top = value[7], tolerance = value[9];
	const int pixels = static_cast<int>(value[8]);

	Register::init("stdplug");
	std::vector<std::string> plugins{"stdplug"};
	SmartPointer<Metric::Generic> metric = (*Metric::getSubcontractor("KerrBL", plugins, 0))(nullptr, plugins);
	metric->set("Spin", Value(0.));

	SmartPointer<Screen> screen = new Screen();
	const double position[4] = {0, value[1], value[2], value[3]};
	screen->metric(metric);
	screen->setObserverPos(position);
	screen->observerKind("ZAMO");
	screen->anglekind("Rectilinear");

	SmartPointer<Photon> photon = new Photon();
	photon->metric(metric);
	// Without an Astrobj, whose DeltaMaxInsideRMax of 1 M makes GYOTO crawl, the tolerances alone set the steps.
	photon->integrator("runge_kutta_fehlberg78");
	photon->absTol(tolerance);
	photon->relTol(tolerance);
	photon->maxiter(100000000);

	for (int j = 0; j < pixels; j++)
		for (int i = 0; i < pixels; i++) {
			// Astronomers' sky: GYOTO's first screen coordinate grows to the left.
			double c[8];
			screen->getRayCoord(-(left + (right - left) * (i + 0.5) / pixels), top + (bottom - top) * (j + 0.5) / pixels, c);
			double g[4][4];
			metric->gmunu(g, c);
			// The photon arrives: one looks where it comes from.
			const double seen[3] = {-std::sqrt(g[3][3]) * c[7], std::sqrt(g[2][2]) * c[6], std::sqrt(g[1][1]) * c[5]};
			const double length = std::sqrt(seen[0] * seen[0] + seen[1] * seen[1] + seen[2] * seen[2]);
			const double b = impact(*metric, c);

			photon->setInitialCondition(metric, SmartPointer<Astrobj::Generic>(nullptr), c);
			photon->xFill(long_ago);
			state_t end;
			photon->getCoord(photon->getImin(), end);
			const double r = end[1];
			const bool captured = r < 2.1; // KerrBL stops at 2.01
			if (!captured && r < far) {
				std::fprintf(stderr, "rays: GYOTO stopped at r = %g M, pixel %d %d\n", r, i, j);
				return 1;
			}
			double d[3] = {0, 0, 0};
			if (!captured) {
				const double st = std::sin(end[2]), ct = std::cos(end[2]), sp = std::sin(end[3]), cp = std::cos(end[3]);
				const double v[3] = {end[5], r * end[6], r * st * end[7]};
				d[0] = -(v[0] * st * cp + v[1] * ct * cp - v[2] * sp);
				d[1] = -(v[0] * st * sp + v[1] * ct * sp + v[2] * cp);
				d[2] = -(v[0] * ct - v[1] * st);
				const double n = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
				for (double& x : d)
					x /= n;
			}
			const double drift = captured ? 0 : impact(*metric, end.data()) / b - 1;
			std::printf("%d %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.3g\n", captured, b, d[0], d[1], d[2], seen[0] / length,
				seen[1] / length, seen[2] / length, drift);
		}
	return 0;
}

} // namespace

int main(int count, char** argument) {
	if (count != 10) {
		std::fprintf(stderr, "rays r theta phi left right bottom top pixels tolerance\n");
		return 2;
	}
	try {
		return run(argument);
	} catch (Gyoto::Error& e) {
		std::cerr << "rays: " << e << "\n";
		return 1;
	}
}
