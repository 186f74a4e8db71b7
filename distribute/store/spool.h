// SPDX-License-Identifier: AGPL-3.0-or-later
/// The server's folder on disk: where everything is, and nothing more.
///
///     ledger.sqlite        what must not be forgotten
///     files/ab/abcd...     the bundles' files by SHA-256
///     bundles/abcd.json    the bundles' lists
///     jobs/7/strips/       a strip's picture: NUMBER-HASH.png
///     jobs/7/frames/       stitched pictures under their own names, then the film
///     incoming/            what is being received; emptied at start
///     url                  where the server listens, while it runs
#ifndef FARM_SPOOL_H
#define FARM_SPOOL_H

#include "distribute/common/files.h"
#include "distribute/protocol/messages.h"
#include "distribute/schedule/types.h"

#include <memory>
#include <optional>
#include <set>

namespace farm {

class Spool {
public:
	/// Makes what is missing and locks the folder; throws Error if another server has it.
	explicit Spool(const fs::path& folder);

	fs::path ledger() const { return root / "ledger.sqlite"; }
	fs::path url() const { return root / "url"; }
	fs::path incoming() const { return root / "incoming"; }
	/// A new name in incoming/.
	fs::path fresh();

	/// A file by its SHA-256, whether it is there or not.
	fs::path file(const std::string& sha256) const { return root / "files" / sha256.substr(0, 2) / sha256; }
	bool has_file(const std::string& sha256) const { return fs::exists(file(sha256)); }
	/// Takes in what was received if its content is what its name says; throws Error if not.
	void keep_file(const fs::path& received, const std::string& sha256);

	std::optional<Bundle> bundle(const std::string& id) const;
	void keep_bundle(const Bundle& bundle);

	fs::path job(JobId id) const { return root / "jobs" / std::to_string(id); }
	/// The job's folders; making them again does no harm.
	void make_job(JobId id) const;
	fs::path strip(JobId id, int strip, const std::string& pixels, const std::string& suffix) const;
	fs::path frame(JobId id, const std::string& picture) const { return job(id) / "frames" / picture; }
	void remove_job(JobId id) const;
	/// Its strips, when they are no longer needed.
	void remove_strips(JobId id) const;
	/// Removes strips' files that are not among these names.
	void keep_strips(JobId id, const std::set<std::string>& names) const;

	/// What all of it takes on the disk.
	std::int64_t bytes() const;
	/// Removes bundles that are not among these, and files that no bundle has any more, if they have lain there for so many
	/// seconds.
	void sweep(const std::set<std::string>& bundles, double seconds) const;

private:
	fs::path root;
	std::unique_ptr<FileLock> lock;
	std::int64_t counter = 0;
};

} // namespace farm
#endif
