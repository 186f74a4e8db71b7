// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/store/mover.h"

#include "distribute/common/error.h"

#include <algorithm>
#include <fcntl.h>
#include <map>
#include <unistd.h>

namespace farm {
namespace {

constexpr size_t most = 256; ///< files open at a time

} // namespace

Mover::Mover() : thread([this] { serve(); }) {}

Mover::~Mover() {
	{
		const std::lock_guard lock(mutex);
		ending = true;
	}
	wake.notify_one();
	thread.join();
}

void Mover::move(fs::path from, fs::path to, Done done) {
	{
		const std::lock_guard lock(mutex);
		queue.push_back({std::move(from), std::move(to), std::move(done), -1, ""});
	}
	wake.notify_one();
}

void Mover::serve() {
	std::unique_lock lock(mutex);
	while (true) {
		wake.wait(lock, [this] { return ending || !queue.empty(); });
		if (queue.empty())
			return;
		const auto end = queue.begin() + static_cast<std::ptrdiff_t>(std::min(queue.size(), most));
		std::vector<Entry> batch(std::make_move_iterator(queue.begin()), std::make_move_iterator(end));
		queue.erase(queue.begin(), end);
		lock.unlock();
		move_all(batch);
		for (Entry& e : batch)
			e.done(e.error);
		lock.lock();
	}
}

void Mover::move_all(std::vector<Entry>& batch) {
	// All on their way to the disk before the first is waited for.
	for (Entry& e : batch) {
		e.descriptor = ::open(e.from.c_str(), O_RDONLY | O_CLOEXEC);
		if (e.descriptor >= 0)
			::sync_file_range(e.descriptor, 0, 0, SYNC_FILE_RANGE_WRITE);
	}
	std::map<fs::path, std::string> folders;
	for (Entry& e : batch) {
		const bool moved = e.descriptor >= 0 && ::fsync(e.descriptor) == 0 && ::rename(e.from.c_str(), e.to.c_str()) == 0;
		if (!moved)
			e.error = system_error("cannot write " + e.to.string()).what();
		else
			folders[e.to.parent_path()];
		if (e.descriptor >= 0)
			::close(e.descriptor);
	}
	for (auto& [folder, error] : folders) {
		try {
			sync_folder(folder);
		} catch (const Error& e) {
			error = e.what();
		}
	}
	for (Entry& e : batch)
		if (e.error.empty())
			e.error = folders[e.to.parent_path()];
}

} // namespace farm
