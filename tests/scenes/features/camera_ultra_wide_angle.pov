// SPDX-License-Identifier: AGPL-3.0-or-later
// The ultra_wide_angle camera before a hole.
#include "world.inc"
#declare Kind = "ultra_wide_angle";
#include "camera.inc"
