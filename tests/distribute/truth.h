// SPDX-License-Identifier: AGPL-3.0-or-later
/// The scheduler's tests have no pictures: a number stands for what a strip shows.
#ifndef TESTS_TRUTH_H
#define TESTS_TRUTH_H

#include "distribute/schedule/types.h"

/// What a good worker finds on a strip; a liar says another.
inline farm::PixelHash truth(farm::JobId job, int strip) { return static_cast<farm::PixelHash>(job * 1000003 + strip + 1); }

#endif
