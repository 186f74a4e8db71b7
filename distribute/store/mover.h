// SPDX-License-Identifier: AGPL-3.0-or-later
/// Files moved to their places durably, as many at a time as have come together: the disk's caches are flushed for all of them at
/// once. What `move_durably` does to one, on a thread of its own.
#ifndef FARM_STORE_MOVER_H
#define FARM_STORE_MOVER_H

#include "distribute/common/files.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace farm {

class Mover {
public:
	Mover();
	/// What was asked for is done first.
	~Mover();
	using Done = std::function<void(const std::string& error)>;
	/// `done` is called from the mover's thread, with an empty string once the file would survive a power cut in its new place.
	/// On one file system.
	void move(fs::path from, fs::path to, Done done);

private:
	struct Entry {
		fs::path from, to;
		Done done;
		int descriptor = -1;
		std::string error;
	};
	void serve();
	static void move_all(std::vector<Entry>& batch);

	std::mutex mutex;
	std::condition_variable wake;
	std::vector<Entry> queue;
	bool ending = false;
	std::thread thread;
};

} // namespace farm
#endif
