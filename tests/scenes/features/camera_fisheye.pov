// SPDX-License-Identifier: AGPL-3.0-or-later
// The fisheye camera before a hole.
#include "world.inc"
#declare Kind = "fisheye";
#include "camera.inc"
