// SPDX-License-Identifier: AGPL-3.0-or-later
// The cylinder 3 camera before a hole.
#include "world.inc"
#declare Kind = "cylinder 3";
#include "camera.inc"
