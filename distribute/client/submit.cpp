// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/client/submit.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/render/povray.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace farm {

const std::vector<Option> scene_options = {
	{"--frames", "A-B", "only these of the animation's frames", ""},
	{"--size", "WxH", "pixels; else what the scene's INI says, or 160x120", ""},
	{"--strips", "N", "strips a frame is cut to, or auto", "auto"},
	{"--priority", "P", "higher first, from -100 to 100", "0"},
	{"--format", "FORMAT", "png or exr; else what the scene's INI says", ""},
	{"--video", "FILE", "the film, .mp4; default the pictures' name; 'none' for none", ""},
	{"--fps", "N", "the film's frames a second", "25"},
	{"--assets", "GLOB", "further files the scene may read, relative to it; may be given again", ""},
	{"--no-sandbox", "", "no fence around the scene, as with povray by hand", ""},
	{"--povray", "FILE", "the povray to run; default the one beside this program", ""},
};

namespace {

/// povray traces whole blocks of so many rows; cuts elsewhere would trace some twice.
constexpr int block = 32;

/// What each strip costs beside its pixels and its parse, about: povray's start, a picture written and read, the way to the
/// server.
constexpr double start_seconds = 0.05;

/// At the job's end slots wait for the last strips, half of one each, but for the one that renders it; and each strip is parsed
/// anew. The length for which both cost the same is the best: s with (cost/s) = (1 - 1/slots)/2 * s/share. Never so short that
/// parsing is above a twentieth of it; half a minute at most, that there is something to see and little to lose. Radiosity's
/// pretrace is done anew on each machine.
double good_seconds(const Gathered& files, int frames, int slots) {
	const double most = std::max(30.0, 20 * files.light_seconds),
				 cost = files.parse_seconds + start_seconds + files.light_seconds;
	const double share = files.frame_seconds * frames / slots, waits = 0.5 * (1 - 1.0 / slots);
	const double best = slots > 1 ? std::sqrt(cost * share / waits) : most;
	return std::max(20 * files.parse_seconds, std::min(most, best));
}

int strip_rows(const JobSpec& spec, const Gathered& files, const std::string& strips, int slots) {
	int count = 0;
	if (strips != "auto") {
		count = static_cast<int>(whole_number(strips, "--strips", 1, limits::pixels));
		if (count > spec.height)
			throw Error("--strips is " + strips + ", and a frame has " + std::to_string(spec.height) + " rows");
	}
	if (!spec.whole_because.empty() || count == 1)
		return spec.height;
	const int blocks = (spec.height + block - 1) / block;
	if (count > blocks) // as asked for, at some cost
		return (spec.height + count - 1) / count;
	if (strips == "auto") {
		const double many = files.frame_seconds / good_seconds(files, spec.frames(), slots);
		count = static_cast<int>(std::clamp(std::round(many), 1.0, static_cast<double>(blocks)));
	}
	return (blocks + count - 1) / count * block;
}

} // namespace

Prepared prepare(const Arguments& arguments, int slots) {
	Prepared p;
	p.scene = settle(arguments.rest, {arguments.get("--frames"), arguments.get("--size"), arguments.get("--format")});
	JobSpec& spec = p.scene.spec;
	spec.priority = static_cast<int>(arguments.number("--priority", -100, 100));
	const std::string& video = arguments.get("--video");
	const double rate = static_cast<double>(arguments.number("--fps", 1, 1000));
	if (video != "none" && (!video.empty() || spec.frames() > 1)) {
		if (!spec.animation)
			throw Error("--video is for animations; the scene has no Final_Frame");
		spec.film_rate = rate;
		p.film = video.empty() ? p.scene.output / (spec.name + ".mp4") : fs::path(video);
		if (p.film.extension() != ".mp4")
			throw Error("--video is '" + video + "'; its name must end in .mp4");
	}
	const fs::path povray = find_povray(arguments.get("--povray"));
	p.sandbox = sandbox_for_own_scenes(povray, !arguments.has("--no-sandbox"));
	p.files = gather(p.scene, {povray, p.sandbox}, arguments.all("--assets"));
	spec.strip_rows = strip_rows(spec, p.files, arguments.get("--strips"), slots);
	spec.check();
	for (const auto& remark : p.scene.remarks)
		say(remark);
	if (!spec.whole_because.empty())
		say("frames are rendered whole: " + spec.whole_because);
	return p;
}

std::int64_t send_job(Client& client, const Prepared& p) {
	const json answer = client.post("/v1/bundles", p.files.bundle);
	for (const auto& hash : answer.at("missing"))
		client.put_file("/v1/files/" + hash.get<std::string>(), p.files.sources.at(hash.get<std::string>()));
	return client.post("/v1/jobs", p.scene.spec).at("job").get<std::int64_t>();
}

} // namespace farm
