// SPDX-License-Identifier: AGPL-3.0-or-later
// The orthographic camera before a hole.
#include "world.inc"
#declare Kind = "orthographic";
#include "camera.inc"
