// SPDX-License-Identifier: AGPL-3.0-or-later
// The cylinder 1 camera before a hole.
#include "world.inc"
#declare Kind = "cylinder 1";
#include "camera.inc"
