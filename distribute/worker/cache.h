// SPDX-License-Identifier: AGPL-3.0-or-later
/// Bundles on the worker's disk: each file is fetched once, whatever bundles have it.
#ifndef FARM_CACHE_H
#define FARM_CACHE_H

#include "distribute/common/files.h"
#include "distribute/http/client.h"
#include "distribute/protocol/messages.h"

#include <mutex>

namespace farm {

/// Safe for several threads and several workers on one machine: everything comes into its place by a rename.
class Cache {
public:
	/// Also throws out what no job has asked for in `keep_days`.
	explicit Cache(const fs::path& folder, double keep_days = 14);
	/// The folder where povray is to run for this bundle, which is fetched if it is not here. `root` gets the bundle's top.
	/// Throws Unreachable, Refused, or Error if a file is not what its hash says.
	fs::path bundle(Client& client, const std::string& id, fs::path& root);

private:
	void fetch(Client& client, const BundleFile& file);

	fs::path folder;
	std::mutex one_at_a_time;
};

} // namespace farm
#endif
