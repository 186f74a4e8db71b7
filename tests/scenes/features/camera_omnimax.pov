// SPDX-License-Identifier: AGPL-3.0-or-later
// The omnimax camera before a hole.
#include "world.inc"
#declare Kind = "omnimax";
#include "camera.inc"
