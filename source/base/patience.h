// SPDX-License-Identifier: AGPL-3.0-or-later
/// How long a polling thread sleeps between looks: briefly while things happen, POV-Ray's own 50 ms once nothing did for long.
///
/// Starting, parsing and ending a render take a dozen looks of several threads in turn; at 50 ms each that is half a second of
/// sleep for a trivial scene, in every frame.
#ifndef POVRAY_BASE_PATIENCE_H
#define POVRAY_BASE_PATIENCE_H

namespace pov_base
{

/// Milliseconds to sleep now, for the calling thread; idle: whether its last look found nothing.
inline int Patience(bool idle)
{
	static thread_local int looks = 0;
	looks = idle ? looks + 1 : 0;
	return looks < 500 ? 1 : 50;
}

}

#endif
