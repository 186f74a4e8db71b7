// SPDX-License-Identifier: AGPL-3.0-or-later
/// Whether a render that says nothing is at work, or hangs.
#ifndef FARM_PULSE_H
#define FARM_PULSE_H

#include <sys/types.h>

namespace farm {

/// Looks at a process and all below it. It hangs when they have slept, every thread of them, for so long, with no more than a
/// thirtieth of that time spent on waking up to look around. What waits for a processor or for a disk, or was stopped by
/// somebody, does not count, nor does time in which nobody looked: the machine may have been asleep.
class Pulse {
public:
	/// `patience`: seconds.
	Pulse(pid_t process, double patience) : root(process), limit(patience) {}
	/// To be called every second or so; `now`: seconds of a clock that never goes back.
	bool hangs(double now);

private:
	pid_t root;
	double limit;
	double looked = -1;    ///< when; negative: not yet
	double slept = 0;      ///< seconds that count
	double spent_then = 0; ///< processor time when that began
};

} // namespace farm
#endif
