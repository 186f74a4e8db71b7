// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/client/show.h"

#include "distribute/common/error.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <sys/ioctl.h>
#include <thread>
#include <unistd.h>

namespace farm {

using nlohmann::json;

void print_table(std::vector<std::vector<std::string>> rows) {
	// Names are others' choice: nothing in them may steer the terminal.
	for (auto& row : rows)
		for (auto& cell : row)
			cell = for_terminal(cell);
	std::vector<size_t> widths;
	for (const auto& row : rows)
		for (size_t c = 0; c < row.size(); ++c) {
			widths.resize(std::max(widths.size(), c + 1));
			widths[c] = std::max(widths[c], row[c].size());
		}
	for (const auto& row : rows) {
		std::string line;
		for (size_t c = 0; c < row.size(); ++c) {
			line += row[c];
			if (c + 1 < row.size())
				line.append(widths[c] - row[c].size() + 2, ' ');
		}
		std::puts(line.c_str());
	}
}

std::string clock_text(double seconds) {
	const long s = std::lround(std::max(0.0, seconds));
	char text[40];
	if (s >= 3600)
		std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
	else
		std::snprintf(text, sizeof text, "%ld:%02ld", s / 60, s % 60);
	return text;
}

std::string progress_text(const json& job) {
	const auto number = [&](const char* key) { return std::to_string(job.value(key, 0)); };
	std::string text = number("frames_done") + "/" + number("frames") + (job.value("frames", 0) == 1 ? " frame, " : " frames, ") +
					   number("strips_done") + "/" + number("strips") + " strips";
	if (job.contains("eta") && job["eta"].is_number())
		text += ", " + clock_text(job["eta"].get<double>()) + " to go";
	if (const std::string doing = job.value("doing", ""); !doing.empty())
		text += ", " + doing;
	return text;
}

ProgressLine::ProgressLine() : terminal(::isatty(2) == 1) {}
ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::show(const std::string& text) {
	if (!terminal)
		return;
	winsize size{};
	const size_t columns = ::ioctl(2, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
	std::string line = for_terminal(text.substr(0, columns));
	const size_t length = line.size();
	line.append(shown > length ? shown - length : 0, ' ');
	std::fprintf(stderr, "\r%s", line.c_str());
	std::fflush(stderr);
	shown = length;
}

void ProgressLine::clear() {
	if (shown) {
		show("");
		std::fprintf(stderr, "\r");
		shown = 0;
	}
}

json follow(Client& client, std::int64_t id, double patience, const std::atomic<bool>& stop,
	const std::function<void(const json&)>& each_time) {
	using Clock = std::chrono::steady_clock;
	ProgressLine progress;
	auto heard = Clock::now();
	json job = json::object();
	std::string told;
	while (!stop) {
		try {
			job = client.get("/v1/jobs/" + std::to_string(id));
			heard = Clock::now();
			const std::string stage = job.value("stage", "");
			if (stage != "running" && stage != "paused")
				return job;
			// An obstacle that somebody has to clear is told where nobody sees the progress, too.
			if (const std::string doing = job.value("doing", ""); doing != told) {
				told = doing;
				if (doing.rfind("waiting: ", 0) == 0) {
					progress.clear();
					say(doing);
				}
			}
			progress.show("job " + std::to_string(id) + ": " + (stage == "paused" ? "paused, " : "") + progress_text(job));
		} catch (const Unreachable&) {
			if (Clock::now() - heard > std::chrono::duration<double>(patience))
				throw;
		}
		// The end is not to be missed by much.
		const double eta = job["eta"].is_number() ? job["eta"].get<double>() : 1;
		std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(eta / 5, 0.03, 0.2)));
		if (each_time)
			each_time(job);
	}
	return job;
}

} // namespace farm
