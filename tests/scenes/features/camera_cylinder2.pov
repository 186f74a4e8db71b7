// SPDX-License-Identifier: AGPL-3.0-or-later
// The cylinder 2 camera before a hole.
#include "world.inc"
#declare Kind = "cylinder 2";
#include "camera.inc"
