// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/worker/cache.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"

#include <nlohmann/json.hpp>

namespace farm {

Cache::Cache(const fs::path& f, double keep_days) : folder(fs::absolute(f)) {
	std::error_code error;
	for (const char* name : {"files", "bundles", "incoming"}) {
		fs::create_directories(folder / name, error);
		if (error)
			throw Error("cannot make " + (folder / name).string() + ": " + error.message());
	}
	const auto old = fs::file_time_type::clock::now() -
					 std::chrono::duration_cast<fs::file_time_type::duration>(std::chrono::duration<double>(keep_days * 86400));
	for (const auto& list : fs::directory_iterator(folder / "bundles"))
		if (list.path().extension() == ".json" && list.last_write_time(error) < old && !error) {
			fs::remove(list.path(), error);
			fs::remove_all(folder / "bundles" / list.path().stem(), error);
		}
	// A file that only we have a name for is in no bundle any more.
	for (const auto& file : fs::directory_iterator(folder / "files"))
		if (file.hard_link_count(error) == 1 && !error && file.last_write_time(error) < old && !error)
			fs::remove(file.path(), error);
}

void Cache::fetch(Client& client, const BundleFile& file) {
	const fs::path place = folder / "files" / file.sha256;
	if (fs::exists(place))
		return;
	const fs::path part = folder / "incoming" / (file.sha256 + "." + random_hex(8));
	try {
		client.download("/v1/files/" + file.sha256, part);
		if (sha256_file(part) != file.sha256)
			throw Unreachable("the file " + file.name + " was damaged on its way");
		// Scenes read, and nothing writes.
		fs::permissions(part, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
		fs::rename(part, place);
	} catch (...) {
		std::error_code ignored;
		fs::remove(part, ignored);
		throw;
	}
}

fs::path Cache::bundle(Client& client, const std::string& id, fs::path& root) {
	const std::lock_guard lock(one_at_a_time);
	root = folder / "bundles" / id;
	const fs::path list = folder / "bundles" / (id + ".json");
	if (!fs::exists(root) || !fs::exists(list)) {
		const Bundle bundle = client.get("/v1/bundles/" + id).get<Bundle>();
		if (bundle.id() != id)
			throw Unreachable("bundle " + id + " was damaged on its way");
		const ScratchFolder scratch(folder / "incoming");
		const fs::path made = scratch.path() / "bundle";
		fs::create_directories(made / bundle.folder);
		for (const auto& file : bundle.files) {
			fetch(client, file);
			fs::create_directories((made / file.name).parent_path());
			fs::create_hard_link(folder / "files" / file.sha256, made / file.name);
		}
		std::error_code taken; // by another worker, just now
		fs::rename(made, root, taken);
		if (!fs::exists(root))
			throw Error("cannot make " + root.string() + ": " + taken.message());
		write_durably(list, json(bundle).dump());
	}
	std::error_code ignored; // when it was last asked for
	fs::last_write_time(list, fs::file_time_type::clock::now(), ignored);
	return root / parse_object(read_file(list)).get<Bundle>().folder;
}

} // namespace farm
