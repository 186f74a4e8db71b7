// SPDX-License-Identifier: AGPL-3.0-or-later
/// What people see: tables, and progress on a terminal.
#ifndef FARM_SHOW_H
#define FARM_SHOW_H

#include "distribute/http/client.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace farm {

/// Columns as wide as they need be, to stdout.
void print_table(std::vector<std::vector<std::string>> rows);
/// 75 seconds as 1:15.
std::string clock_text(double seconds);
/// One line about a job.
std::string progress_text(const nlohmann::json& job);

/// A line on the terminal that is written over; nothing where stderr is no terminal.
class ProgressLine {
public:
	ProgressLine();
	~ProgressLine();
	void show(const std::string& text);
	void clear();

private:
	bool terminal;
	size_t shown = 0;
};

/// Follows a job to its end; returns it as it stands then. Lost connections are tried again for `patience` seconds. Ends early
/// when `stop` is set. `each_time`, if there is one, is called five times a second or more often, with the job as it stood last.
nlohmann::json follow(Client& client, std::int64_t job, double patience, const std::atomic<bool>& stop,
	const std::function<void(const nlohmann::json&)>& each_time = {});

} // namespace farm
#endif
