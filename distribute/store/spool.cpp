// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/store/spool.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"

#include <nlohmann/json.hpp>

namespace farm {

Spool::Spool(const fs::path& folder) {
	std::error_code error;
	fs::create_directories(folder, error);
	if (error)
		throw Error("cannot make the spool " + folder.string() + ": " + error.message());
	root = fs::absolute(folder);
	lock = std::make_unique<FileLock>(root / "lock", "another bhfarm-server has the spool " + root.string());
	fs::remove_all(incoming(), error);
	for (const char* name : {"files", "bundles", "jobs", "incoming"}) {
		fs::create_directories(root / name, error);
		if (error)
			throw Error("cannot make " + (root / name).string() + ": " + error.message());
	}
}

fs::path Spool::fresh() { return incoming() / std::to_string(++counter); }

void Spool::keep_file(const fs::path& received, const std::string& sha256) {
	if (const std::string is = sha256_file(received); is != sha256)
		throw Error("what came has the SHA-256 " + is + ", not " + sha256);
	fs::create_directories(file(sha256).parent_path());
	move_durably(received, file(sha256));
}

std::optional<Bundle> Spool::bundle(const std::string& id) const {
	const fs::path list = root / "bundles" / (id + ".json");
	if (!fs::exists(list))
		return std::nullopt;
	return parse_object(read_file(list)).get<Bundle>();
}

void Spool::keep_bundle(const Bundle& bundle) { write_durably(root / "bundles" / (bundle.id() + ".json"), json(bundle).dump()); }

void Spool::make_job(JobId id) const {
	for (const char* name : {"strips", "frames"})
		fs::create_directories(job(id) / name);
}

fs::path Spool::strip(JobId id, int strip, const std::string& pixels, const std::string& suffix) const {
	return job(id) / "strips" / (std::to_string(strip) + "-" + pixels.substr(0, 16) + suffix);
}

void Spool::remove_job(JobId id) const {
	std::error_code ignored;
	fs::remove_all(job(id), ignored);
}

} // namespace farm
