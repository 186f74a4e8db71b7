// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/scene/settle.h"

#include "distribute/common/arguments.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace farm {
namespace {

/// Said to POV-Ray by the farm itself, or without a meaning there.
const char* const dropped[] = {"Display", "Display_Words", "Display_Gamma", "Verbose", "Pause_When_Done", "All_Console",
	"All_File", "Debug_Console", "Debug_File", "Fatal_Console", "Fatal_File", "Render_Console", "Render_File",
	"Statistic_Console", "Statistic_File", "Warning_Console", "Warning_File", "Append_File", "Continue_Trace", "Create_Ini",
	"Work_Threads", "Preview_Start_Size", "Preview_End_Size", "Video_Mode", "Palette", "Test_Abort", "Test_Abort_Count",
	"Draw_Vistas", "Output_To_File", "Render_Pattern", "Render_Block_Step", "Buffer_Output", "Reproducible", "Pixels_To_File",
	"Pixels_From_File", "Buffer_Size"};
/// Left out with a word about it.
const char* const remarked[] = {"Ray_Paths", "Ray_Paths_Grid", "Radiosity_File_Name", "Radiosity_From_File", "Radiosity_To_File"};
const char* const refused[] = {"Start_Row", "End_Row", "Start_Column", "End_Column", "Real_Time_Raytracing",
	"Clockless_Animation", "Field_Render", "Odd_Field", "Post_Frame_Command", "Post_Scene_Command", "Pre_Frame_Command",
	"Pre_Scene_Command", "User_Abort_Command", "Fatal_Error_Command", "Post_Frame_Return", "Post_Scene_Return",
	"Pre_Frame_Return", "Pre_Scene_Return", "User_Abort_Return", "Fatal_Error_Return"};

template <class List> bool among(const std::string& key, const List& list) {
	return std::any_of(std::begin(list), std::end(list), [&](const char* name) { return same_key(key, name); });
}

double real(const std::string& text, const std::string& what) {
	double value = 0;
	const char* end = text.data() + text.size();
	const auto [at, error] = std::from_chars(text.data(), end, value);
	if (error != std::errc() || at != end || !std::isfinite(value))
		throw Error(what + " is '" + text + "'; it must be a number");
	return value;
}

/// The one INI file that POV-Ray reads by itself; empty if there is none.
fs::path povray_ini() {
	const char* named = std::getenv("POVINI");
	const char* home = std::getenv("HOME");
	std::vector<fs::path> places;
	if (named && *named)
		places.emplace_back(named);
	places.emplace_back("povray.ini");
	if (home && *home)
		places.push_back(fs::path(home) / ".povray/3.7/povray.ini");
	places.emplace_back("/etc/povray/3.7/povray.ini");
	for (const auto& place : places)
		if (fs::exists(place))
			return place;
	return {};
}

/// POV-Ray's own includes and ours, installed or in the build tree.
std::vector<fs::path> own_libraries() {
	const fs::path here = program_folder();
	std::vector<fs::path> found;
	for (const char* place :
		{"../share/povray-3.7/include", "../../upstream/tree/distribution/include", "../../../scenes/include"})
		if (const fs::path folder = (here / place).lexically_normal(); fs::is_directory(folder))
			found.push_back(folder);
	return found;
}

/// The frame numbers as POV-Ray's Subset_Start_Frame counts them: a fraction below 1 is a part of the animation (manual, "Subsets
/// of animation frames").
int subset(const std::string& text, const char* key, int first, int last) {
	const double value = real(text, key);
	return value <= 0 || value >= 1 ? static_cast<int>(value) : static_cast<int>((last - first + 1) * value);
}

class Settler {
public:
	SettledScene result;

	void take(const std::vector<Setting>& settings, const fs::path& beside) {
		for (const auto& [key, value] : settings) {
			JobSpec& spec = result.spec;
			const auto is = [&key = key](const char* name) { return same_key(key, name); };
			const auto number = [&key = key, &value = value](
									long least, long most) { return static_cast<int>(whole_number(value, key, least, most)); };
			if (is("Input_File_Name"))
				scene = fs::path(value).is_relative() && fs::exists(beside / value) ? beside / value : fs::path(value);
			else if (is("Output_File_Name"))
				output = value;
			else if (is("Library_Path"))
				result.libraries.push_back(fs::absolute(value).lexically_normal());
			else if (is("Width"))
				spec.width = number(1, limits::pixels);
			else if (is("Height"))
				spec.height = number(1, limits::pixels);
			else if (is("Output_File_Type"))
				type = value;
			else if (is("Bits_Per_Color") || is("Bits_Per_Colour"))
				bits = number(1, 32);
			else if (is("Dither"))
				dither = is_on(value);
			else if (is("Subset_Start_Frame"))
				from = value;
			else if (is("Subset_End_Frame"))
				to = value;
			else if (is("Frame_Step"))
				spec.step = std::max(number(INT32_MIN, INT32_MAX), 1);
			else if (among(key, refused))
				throw Error(key + " does not work in a farm; leave it out");
			else if (among(key, remarked))
				result.remarks.push_back(key + " is left out: it would write one file for many strips");
			else if (!among(key, dropped))
				keep(key, value);
		}
	}

	void finish(const Wishes& wishes) {
		JobSpec& spec = result.spec;
		if (scene.empty())
			throw Error("no scene is named: give a .pov, or an .ini with Input_File_Name");
		find_scene();
		if (!wishes.size.empty()) {
			const size_t x = wishes.size.find('x');
			spec.width = static_cast<int>(whole_number(wishes.size.substr(0, x), "the width in --size", 1, limits::pixels));
			spec.height = static_cast<int>(
				whole_number(x == std::string::npos ? "" : wishes.size.substr(x + 1), "the height in --size", 1, limits::pixels));
		}
		// POV-Ray's own default is 160x120.
		spec.width = spec.width ? spec.width : 160;
		spec.height = spec.height ? spec.height : 120;
		spec.check_size();
		frames(wishes.frames);
		format(wishes.format);
		fs::path name = output.filename();
		if (name.extension() == spec.suffix())
			name = name.stem();
		result.output = fs::is_directory(output) ? output : output.parent_path();
		spec.name = name.empty() || fs::is_directory(output) ? result.scene.stem().string() : name.string();
		if (dither) {
			spec.whole_because = "dither passes on its errors from row to row";
			kept.emplace_back("Dither", "On");
		}
		for (const auto& s : kept)
			spec.options.push_back(ini_line(s));
	}

private:
	void keep(const std::string& key, const std::string& value) {
		if (same_key(key, "Declare")) {
			kept.emplace_back("Declare", value);
			return;
		}
		const auto known = std::find_if(kept.begin(), kept.end(), [&](const Setting& s) { return same_key(s.first, key); });
		if (known != kept.end())
			kept.erase(known);
		kept.emplace_back(key, value);
	}

	std::string kept_value(const char* key, const std::string& otherwise) const {
		for (const auto& s : kept)
			if (same_key(s.first, key))
				return s.second;
		return otherwise;
	}

	void find_scene() {
		std::vector<fs::path> places = {scene};
		if (scene.is_relative())
			for (const auto& l : result.libraries)
				places.push_back(l / scene);
		for (const auto& place : places)
			for (const fs::path& file : {place, fs::path(place.string() + ".pov")})
				if (fs::is_regular_file(file)) {
					result.scene = fs::absolute(file).lexically_normal();
					return;
				}
		throw Error("there is no scene " + scene.string());
	}

	void frames(const std::string& wish) {
		JobSpec& spec = result.spec;
		// POV-Ray takes no number, 0 and 0, and 1 and 1 for one picture without a number.
		const long given_first = whole_number(kept_value("Initial_Frame", "0"), "Initial_Frame", INT32_MIN, INT32_MAX);
		const long given_last = whole_number(kept_value("Final_Frame", "0"), "Final_Frame", INT32_MIN, INT32_MAX);
		const bool cyclic = is_on(kept_value("Cyclic_Animation", "off"));
		const bool single = (given_first == 0 && given_last == 0) || (given_first == 1 && given_last == 1);
		if (single) {
			if (!wish.empty())
				throw Error("--frames is for animations; the scene has no Final_Frame");
			spec.step = 1;
			return;
		}
		spec.animation = true;
		const int first = static_cast<int>(std::max(kept_value("Initial_Frame", "").empty() ? 1L : given_first, 0L));
		const int final = static_cast<int>(kept_value("Final_Frame", "").empty() ? 1L : given_last);
		if (final < first)
			throw Error("Final_Frame is " + std::to_string(final) + ", below Initial_Frame " + std::to_string(first));
		if (final == first && !cyclic)
			throw Error("Initial_Frame and Final_Frame are both " + std::to_string(first) +
						": POV-Ray's clock would be no number; use Subset_Start_Frame");
		const int last = final + (cyclic ? 1 : 0);
		spec.first = from.empty() ? first : std::max(subset(from, "Subset_Start_Frame", first, last), first);
		spec.last = to.empty() ? final : subset(to, "Subset_End_Frame", first, last);
		if (!wish.empty()) {
			const size_t dash = wish.find('-');
			spec.first = static_cast<int>(whole_number(wish.substr(0, dash), "the first of --frames", first, final));
			spec.last = dash == std::string::npos
							? spec.first
							: static_cast<int>(whole_number(wish.substr(dash + 1), "the last of --frames", spec.first, final));
		}
		if (spec.last < spec.first)
			throw Error(
				"the last frame asked for is " + std::to_string(spec.last) + ", below the first, " + std::to_string(spec.first));
		if (spec.last > last)
			throw Error("the last frame asked for is " + std::to_string(spec.last) + "; Final_Frame is " + std::to_string(final));
		spec.digits = static_cast<int>(std::to_string(last).size());
	}

	void format(const std::string& wish) {
		JobSpec& spec = result.spec;
		std::string wanted = wish;
		if (wanted.empty()) {
			const char t = type.empty() ? 'N' : static_cast<char>(std::toupper(static_cast<unsigned char>(type[0])));
			if (t != 'N' && t != 'E')
				throw Error(
					"Output_File_Type is '" + type + "'; the farm makes N (PNG) and E (OpenEXR): say --format png or exr");
			wanted = t == 'N' ? "png" : "exr";
		}
		if (wanted != "png" && wanted != "exr")
			throw Error("--format is '" + wanted + "'; it must be png or exr");
		spec.format = wanted == "png" ? Format::png : Format::exr;
		if (spec.format == Format::png && bits != 8 && bits != 16)
			throw Error("Bits_Per_Color is " + std::to_string(bits) + "; for PNG the farm takes 8 or 16");
		// EXR has half floats, or with our povray 32 bits.
		spec.bits = spec.format == Format::png ? bits : bits == 32 ? 32 : 16;
		dither = dither && spec.format == Format::png;
	}

	std::vector<Setting> kept;
	fs::path scene, output;
	std::string type, from, to;
	int bits = 8;
	bool dither = false;
};

} // namespace

SettledScene settle(const std::vector<std::string>& words, const Wishes& wishes) {
	Settler settler;
	if (const fs::path ini = povray_ini(); !ini.empty())
		settler.take(read_ini(ini.string()), "");
	if (words.empty())
		throw Error("no scene is named");
	for (size_t i = 0; i < words.size(); ++i) {
		// The first word may be an .ini elsewhere, whose scene is beside it.
		const std::string file = words[i].substr(0, words[i].find('['));
		const fs::path beside = i == 0 ? fs::path(file).parent_path() : fs::path();
		if (i == 0 && !fs::is_regular_file(file))
			throw Error("there is no scene " + file);
		settler.take(read_word(words[i]), beside);
	}
	for (const auto& library : own_libraries())
		settler.result.libraries.push_back(library);
	settler.result.libraries.insert(settler.result.libraries.begin(), fs::current_path());
	settler.finish(wishes);
	return std::move(settler.result);
}

std::vector<fs::path> SettledScene::folders() const {
	std::vector<fs::path> all = {scene.parent_path()};
	all.insert(all.end(), libraries.begin(), libraries.end());
	return all;
}

} // namespace farm
