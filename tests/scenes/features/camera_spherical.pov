// SPDX-License-Identifier: AGPL-3.0-or-later
// The spherical camera before a hole.
#include "world.inc"
#declare Kind = "spherical";
#include "camera.inc"
