// SPDX-License-Identifier: AGPL-3.0-or-later
/// A server and a worker of one's own.
#ifndef FARM_LOCAL_FARM_H
#define FARM_LOCAL_FARM_H

#include "distribute/common/files.h"
#include "distribute/common/process.h"

#include <atomic>
#include <optional>
#include <string>

namespace farm {

struct LocalFarmSettings {
	fs::path state;     ///< all they keep is in there
	int slots = 1;      ///< of the worker
	std::string povray; ///< empty: the one beside this program
	bool fenced = true;
};

/// Both are started again should one of them die.
class LocalFarm {
public:
	explicit LocalFarm(const LocalFarmSettings& settings) : set(settings) {}
	~LocalFarm() { stop(false); }
	LocalFarm(const LocalFarm&) = delete;

	fs::path spool() const { return set.state / "spool"; }
	/// Where it listens; empty if `interrupted` came first. Throws Error with the server's own last line.
	std::string start_server(const std::atomic<bool>& interrupted);
	void start_worker();
	/// Throws Error if they die again and again.
	void mend(const std::atomic<bool>& interrupted);
	/// `all_done`: nothing is to be given back, so that the worker need not be waited for before the server goes.
	void stop(bool all_done);

private:
	LocalFarmSettings set;
	std::string url, address = "127.0.0.1:0";
	std::optional<Process> server, worker;
	int deaths = 0;
};

} // namespace farm
#endif
