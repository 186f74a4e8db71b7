// SPDX-License-Identifier: AGPL-3.0-or-later
// The perspective camera before a hole.
#include "world.inc"
#declare Kind = "perspective";
#include "camera.inc"
