// SPDX-License-Identifier: AGPL-3.0-or-later
// The cylinder 4 camera before a hole.
#include "world.inc"
#declare Kind = "cylinder 4";
#include "camera.inc"
