// SPDX-License-Identifier: AGPL-3.0-or-later
/// How long to wait before asking again.
#ifndef FARM_WORKER_BACKOFF_H
#define FARM_WORKER_BACKOFF_H

#include <algorithm>
#include <cstdlib>

namespace farm {

/// Doubles from a tenth of a second to ten, a little different for each so that they do not all come at once.
class Backoff {
public:
	double next() {
		seconds = std::min(10.0, seconds * 2);
		return seconds * (0.5 + std::rand() / (RAND_MAX + 1.0));
	}
	void reset() { seconds = 0.05; }

private:
	double seconds = 0.05;
};

} // namespace farm
#endif
