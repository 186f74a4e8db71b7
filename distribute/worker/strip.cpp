// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/worker/strip.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/render/povray.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>

namespace farm {
namespace {

std::string tail(const std::string& text, size_t most) { return text.size() <= most ? text : text.substr(text.size() - most); }

/// The end of what povray printed; a scene may print without end.
std::string end_of(const fs::path& log) {
	constexpr std::streamoff most = 1 << 20;
	std::ifstream in(log, std::ios::binary | std::ios::ate);
	if (!in)
		return "";
	const std::streamoff size = in.tellg();
	in.seekg(std::max<std::streamoff>(0, size - most));
	return {std::istreambuf_iterator<char>(in), {}};
}

/// The picture that povray wrote: it adds the frame's number to the name, so a folder of its own tells. Links are not followed,
/// whoever made them. Throws Error if the scene has written one too: which comes first hangs on the machine.
fs::path picture_in(const fs::path& folder, const std::string& suffix) {
	fs::path picture;
	for (const auto& entry : fs::directory_iterator(folder))
		if (entry.path().extension() == suffix && entry.symlink_status().type() == fs::file_type::regular) {
			if (!picture.empty())
				throw Error("the scene writes pictures of its own to where the strip's goes");
			picture = entry.path();
		}
	return picture;
}

} // namespace

Rendered render_strip(const Renderer& renderer, const Task& task, const fs::path& root, const fs::path& folder,
	const fs::path& scratch, const std::function<bool()>& give_up) {
	// A scene that writes a file and reads it again finds it where it runs, and no strip finds another's; all else is in the
	// bundle, whose folders are there too.
	const fs::path out = scratch / "out", here = scratch / "here", ini = scratch / "strip.ini", log = scratch / "log";
	fs::create_directory(out);
	fs::copy(folder, here, fs::copy_options::directories_only | fs::copy_options::recursive);
	std::string lines = scene_in(folder) + strip_ini(task, out / ("whole" + task.spec.suffix()));
	const bool share = renderer.light && task.rows < task.spec.height,
			   known = share && renderer.light->fetch(task, scratch / "light");
	if (share)
		lines += "Radiosity_File_Name=\"" + ((known ? scratch : out) / "light").string() + "\"\n" +
				 (known ? "Radiosity_From_File=On\n" : "Radiosity_To_File=On\n");
	write_scratch(ini, lines);
	Command command = povray_command(renderer.povray, ini, here);
	command.folder = here;
	command.log = log;
	command.nice = renderer.nice;

	Rendered result;
	std::string limit;
	Overseer overseer(renderer.limits, scratch);
	const auto start = std::chrono::steady_clock::now();
	Process process(renderer.sandbox.fenced(command, {{root, scratch}, {out, here}, false}, renderer.limits));
	while (limit.empty() && !process.over(0.1)) {
		result.given_up = give_up();
		if (result.given_up)
			return result; // and povray ends with the process
		limit = overseer.complaint();
	}
	if (!limit.empty()) {
		process.signal(SIGKILL);
		process.over(-1);
	}
	result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	const std::string output = end_of(log);
	if (limit.empty())
		limit = overseer.complaint(process.code(), output);
	result.not_started = limit.empty() && process.code() != 0 && did_not_start(output);
	const bool good = limit.empty() && process.code() == 0;
	if (share && good && !known)
		renderer.light->keep(task, out / "light");
	else if (known && !good)
		renderer.light->forget(task);
	if (good)
		result.picture = picture_in(out, task.spec.suffix());
	result.failure = {tail(limit.empty() ? error_line(output, process.code(), folder) : limit, 1900),
		tail(output, static_cast<size_t>(limits::log_bytes) / 2)};
	return result;
}

} // namespace farm
