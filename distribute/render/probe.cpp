// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/render/probe.h"

#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/render/povray.h"
#include "distribute/stitch/picture.h"

namespace farm {
namespace {

const char* const scene = R"(#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -14> look_at 0 angle 50 }
blackhole { 0, 1 effect_radius 30 }
light_source { <10, 20, -20> rgb 1 area_light x*4, z*4, 3, 3 jitter }
sky_sphere { pigment { granite turbulence 0.3 color_map { [0 rgb 0] [1 rgb <1, 0.8, 0.5>] } } }
plane { y, -3 pigment { function { sin(x)*exp(-z*z/50)*cos(atan2(z, x)) } } finish { crand 0.2 } }
sphere { <3, 0, 2>, 1 pigment { bozo } normal { bumps 0.4 scale 0.2 } finish { reflection 0.4 specular 0.6 roughness 0.02 } }
superellipsoid { <0.3, 0.7> scale 1.2 translate <-3, -1, 1> pigment { rgbt <0.8, 1, 0.9, 0.7> } interior { ior 1.4 } }
)";

} // namespace

std::string probe(const std::filesystem::path& povray, const Sandbox& sandbox) {
	const ScratchFolder scratch(fs::temp_directory_path());
	Task task;
	task.spec.options = {"Input_File_Name=probe.pov", "Antialias=On", "Sampling_Method=2"};
	task.spec.width = 40;
	task.spec.height = task.spec.strip_rows = task.rows = 30;
	task.spec.bits = 16;
	write_scratch(scratch.path() / "probe.pov", scene);
	write_scratch(scratch.path() / "probe.ini", strip_ini(task, scratch.path() / "probe.png"));
	Command command = povray_command(povray, scratch.path() / "probe.ini", scratch.path());
	command.folder = scratch.path();
	command.log = scratch.path() / "log";
	const auto [code, log] = run_povray(sandbox.fenced(command, {{}, {scratch.path()}, false}));
	if (code != 0)
		throw Error(povray.string() + ": " + error_line(log, code));
	return check_strip(task.spec, 0, task.rows, scratch.path() / "probe.png");
}

} // namespace farm
