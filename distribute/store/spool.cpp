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

void Spool::remove_strips(JobId id) const {
	std::error_code ignored;
	fs::remove_all(job(id) / "strips", ignored);
}

void Spool::keep_strips(JobId id, const std::set<std::string>& names) const {
	std::error_code ignored;
	for (const auto& entry : fs::directory_iterator(job(id) / "strips", ignored))
		if (!names.count(entry.path().filename()))
			fs::remove(entry.path(), ignored);
}

std::int64_t Spool::bytes() const {
	std::int64_t sum = 0;
	std::error_code ignored;
	for (fs::recursive_directory_iterator at(root, fs::directory_options::skip_permission_denied, ignored), end; at != end;
		 at.increment(ignored))
		if (const auto size = at->is_regular_file(ignored) ? at->file_size(ignored) : 0; !ignored)
			sum += static_cast<std::int64_t>(size);
	return sum;
}

void Spool::sweep(const std::set<std::string>& bundles, double seconds) const {
	const auto old = fs::file_time_type::clock::now() -
					 std::chrono::duration_cast<fs::file_time_type::duration>(std::chrono::duration<double>(seconds));
	std::set<std::string> needed;
	for (const auto& entry : fs::directory_iterator(root / "bundles")) {
		if (bundles.count(entry.path().stem()) || entry.last_write_time() > old) {
			const Bundle bundle = parse_object(read_file(entry.path())).get<Bundle>();
			for (const auto& file : bundle.files)
				needed.insert(file.sha256);
		} else {
			fs::remove(entry.path());
		}
	}
	for (const auto& entry : fs::recursive_directory_iterator(root / "files"))
		if (entry.is_regular_file() && entry.last_write_time() <= old && !needed.count(entry.path().filename()))
			fs::remove(entry.path());
}

} // namespace farm
