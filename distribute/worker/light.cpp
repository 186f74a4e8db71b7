// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/worker/light.h"

#include "distribute/common/hash.h"
#include "distribute/render/povray.h"

#include <algorithm>

namespace farm {

fs::path LightStore::place_of(const Task& task) const {
	return scratch.path() / sha256(task.spec.bundle + "\n" + povray_ini(task.spec, task.frame));
}

bool LightStore::fetch(const Task& task, const fs::path& place) const {
	std::error_code none;
	fs::create_hard_link(place_of(task), place, none);
	return !none;
}

void LightStore::keep(const Task& task, const fs::path& written) const {
	std::error_code error;
	if (fs::symlink_status(written, error).type() != fs::file_type::regular || fs::file_size(written, error) == 0 || error)
		return;
	fs::rename(written, place_of(task), error);
	// Strips go out frame by frame: what was made long ago is not asked for again.
	constexpr size_t most = 16;
	std::vector<std::pair<fs::file_time_type, fs::path>> all;
	for (const auto& entry : fs::directory_iterator(scratch.path(), error))
		all.emplace_back(entry.last_write_time(error), entry.path());
	std::sort(all.begin(), all.end());
	for (size_t i = 0; i + most < all.size(); ++i)
		fs::remove(all[i].second, error);
}

void LightStore::forget(const Task& task) const {
	std::error_code ignored;
	fs::remove(place_of(task), ignored);
}

} // namespace farm
