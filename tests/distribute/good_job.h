// SPDX-License-Identifier: AGPL-3.0-or-later
/// A job that nothing is wrong with, for tests to spoil.
#ifndef TESTS_GOOD_JOB_H
#define TESTS_GOOD_JOB_H

#include "distribute/protocol/messages.h"

inline farm::JobSpec good_job() {
	farm::JobSpec spec;
	spec.name = "film";
	spec.bundle = std::string(64, 'a');
	spec.options = {"Antialias=On", "Declare=A=1"};
	spec.width = 640;
	spec.height = 360;
	spec.animation = true;
	spec.first = 1;
	spec.last = 24;
	spec.digits = 2;
	spec.strip_rows = 64;
	return spec;
}

#endif
