// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/worker/strip.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/hash.h"
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
/// whoever made them.
fs::path picture_in(const fs::path& folder, const std::string& suffix) {
	for (const auto& entry : fs::directory_iterator(folder))
		if (entry.path().extension() == suffix && entry.symlink_status().type() == fs::file_type::regular)
			return entry.path();
	return {};
}

} // namespace

Rendered render_strip(const Renderer& renderer, const Task& task, const fs::path& root, const fs::path& folder,
	const fs::path& scratch, const std::function<bool()>& give_up) {
	// What a scene sees is the same on each worker and for each strip, lest it make good workers differ: the bundle, and where it
	// runs, are at fixed places; what else there is for povray alone has a name that nobody can guess, and no scene can list a
	// folder. What a scene writes, it finds again where it runs, and no strip finds another's.
	const Sandbox& sandbox = renderer.sandbox;
	const std::string secret = random_hex(16);
	const Seen bundle = sandbox.placed(root, "/scene"), here = sandbox.placed(scratch / "here", "/farm/here"),
			   own = sandbox.placed(scratch / secret, "/" + secret), out(own.from / "out", own.at / "out");
	const fs::path scene = (bundle.at / folder.lexically_relative(root)).lexically_normal(), log = own.from / "log";
	fs::create_directories(out.from);
	fs::copy(folder, here.from, fs::copy_options::directories_only | fs::copy_options::recursive);
	std::string lines = scene_in(scene) + strip_ini(task, out.at / ("whole" + task.spec.suffix()));
	const bool share = renderer.light && task.rows < task.spec.height,
			   known = share && renderer.light->fetch(task, own.from / "light");
	if (share)
		lines += "Radiosity_File_Name=\"" + ((known ? own : out).at / "light").string() + "\"\n" +
				 (known ? "Radiosity_From_File=On\n" : "Radiosity_To_File=On\n");
	write_scratch(own.from / "strip.ini", lines);
	Command command = povray_command(renderer.povray, own.at / "strip.ini", here.at);
	command.folder = here.at;
	command.log = log;
	command.nice = renderer.nice;

	Rendered result;
	std::string limit;
	Overseer overseer(renderer.limits, scratch);
	const auto start = std::chrono::steady_clock::now();
	Process process(sandbox.fenced(command, {{bundle, own}, {out, here}, false}, renderer.limits));
	overseer.watch(process.id());
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
		renderer.light->keep(task, out.from / "light");
	else if (known && !good)
		renderer.light->forget(task);
	if (good)
		result.picture = picture_in(out.from, task.spec.suffix());
	result.failure = {tail(limit.empty() ? error_line(output, process.code(), scene) : limit, 1900),
		tail(output, static_cast<size_t>(limits::log_bytes) / 2), !limit.empty()};
	return result;
}

} // namespace farm
