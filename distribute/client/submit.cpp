// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/client/submit.h"

#include "distribute/client/show.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/render/povray.h"
#include "distribute/scene/cuts.h"

#include <nlohmann/json.hpp>

#include <algorithm>

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
	povray_option,
};

namespace {

/// --strips: 0 is auto.
int asked_strips(const Arguments& arguments, const JobSpec& spec) {
	const std::string& strips = arguments.get("--strips");
	const int count = strips == "auto" ? 0 : static_cast<int>(whole_number(strips, "--strips", 1, limits::pixels));
	if (count > spec.height)
		throw Error("--strips is " + strips + ", and a frame has " + std::to_string(spec.height) + " rows");
	return count;
}

} // namespace

Prepared prepare(const Arguments& arguments) {
	Prepared p;
	p.scene = settle(arguments.rest, {arguments.get("--frames"), arguments.get("--size"), arguments.get("--format")});
	JobSpec& spec = p.scene.spec;
	spec.priority = static_cast<int>(arguments.number("--priority", -100, 100));
	asked_strips(arguments, spec);
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
	p.povray = find_povray(arguments.get("--povray"));
	p.sandbox = sandbox_for_own_scenes(p.povray, !arguments.has("--no-sandbox"));
	for (const auto& remark : p.scene.remarks)
		say(remark);
	return p;
}

void try_out(Prepared& p, const Arguments& arguments, int slots, const std::atomic<bool>* stop) {
	JobSpec& spec = p.scene.spec;
	{
		ProgressLine progress;
		const auto show = [&](const std::string& what) { progress.show("trying it out: " + what); };
		p.files = gather(p.scene, {p.povray, p.sandbox, stop, show}, arguments.all("--assets"));
	}
	spec.strip_rows = strip_rows(spec, p.files, asked_strips(arguments, spec), slots);
	spec.check();
	if (!spec.whole_because.empty())
		say("frames are rendered whole: " + spec.whole_because);
}

std::int64_t send_job(Client& client, const Prepared& p) {
	const json answer = client.post("/v1/bundles", p.files.bundle);
	for (const auto& hash : answer.at("missing"))
		client.put_file("/v1/files/" + hash.get<std::string>(), p.files.sources.at(hash.get<std::string>()));
	return client.post("/v1/jobs", p.scene.spec).at("job").get<std::int64_t>();
}

} // namespace farm
