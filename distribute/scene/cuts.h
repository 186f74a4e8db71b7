// SPDX-License-Identifier: AGPL-3.0-or-later
/// How many strips a frame is best cut to.
#ifndef FARM_CUTS_H
#define FARM_CUTS_H

#include "distribute/scene/gather.h"

namespace farm {

/// Rows of a strip. `count`: strips a frame, 1 to its height; 0: as many as have the job done first on so many slots, by what
/// the scene's tries took. Cuts are at whole blocks of povray's as far as there are that many.
int strip_rows(const JobSpec& spec, const Gathered& files, int count, int slots);

} // namespace farm
#endif
