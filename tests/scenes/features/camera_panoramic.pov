// SPDX-License-Identifier: AGPL-3.0-or-later
// The panoramic camera before a hole.
#include "world.inc"
#declare Kind = "panoramic";
#include "camera.inc"
