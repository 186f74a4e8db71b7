// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/scene/switches.h"

#include "distribute/common/error.h"

#include <cctype>

namespace farm {
namespace {

struct Switch {
	const char* name;
	const char* value; // the key that what follows goes to; null: nothing may follow
	const char* truth; // the key that + sets On and - sets Off; null: the sign means nothing
};

// POV-Ray takes the first whose name begins the word and that agrees about whether something follows (manual, "Command-line
// switches").
const Switch switches[] = {
	{"AG", "Antialias_Gamma", nullptr},
	{"AM", "Sampling_Method", nullptr},
	{"A", "Antialias_Threshold", "Antialias"},
	{"A", nullptr, "Antialias"},
	{"BM", "Bounding_Method", nullptr},
	{"BS", "Render_Block_Size", nullptr},
	{"B", nullptr, "Bounding"},
	{"C", nullptr, "Continue_Trace"},
	{"D", "Display_Words", "Display"},
	{"D", nullptr, "Display"},
	{"EC", "End_Column", nullptr},
	{"EF", "Subset_End_Frame", nullptr},
	{"EP", "Preview_End_Size", nullptr},
	{"ER", "End_Row", nullptr},
	{"F", "Output_File_Type", "Output_To_File"},
	{"F", nullptr, "Output_To_File"},
	{"GA", "All_File", "All_Console"},
	{"GA", nullptr, "All_Console"},
	{"GD", "Debug_File", "Debug_Console"},
	{"GD", nullptr, "Debug_Console"},
	{"GF", "Fatal_File", "Fatal_Console"},
	{"GF", nullptr, "Fatal_Console"},
	{"GI", "Create_Ini", nullptr},
	{"GP", nullptr, "Append_File"},
	{"GR", "Render_File", "Render_Console"},
	{"GR", nullptr, "Render_Console"},
	{"GS", "Statistic_File", "Statistic_Console"},
	{"GS", nullptr, "Statistic_Console"},
	{"GW", "Warning_File", "Warning_Console"},
	{"GW", nullptr, "Warning_Console"},
	{"HI", "Include_Header", nullptr},
	{"HR", nullptr, "High_Reproducibility"},
	{"H", "Height", nullptr},
	{"I", "Input_File_Name", nullptr},
	{"J", "Jitter_Amount", "Jitter"},
	{"J", nullptr, "Jitter"},
	{"KC", nullptr, "Cyclic_Animation"},
	{"KI", "Initial_Clock", nullptr},
	{"KFF", "Final_Frame", nullptr},
	{"KFI", "Initial_Frame", nullptr},
	{"KF", "Final_Clock", nullptr},
	{"KLA", nullptr, "Clockless_Animation"},
	{"K", "Clock", nullptr},
	{"L", "Library_Path", nullptr},
	{"MB", "Bounding_Threshold", "Bounding"},
	{"MB", nullptr, "Bounding"},
	{"MI", "Max_Image_Buffer_Memory", nullptr},
	{"MV", "Version", nullptr},
	{"O", "Output_File_Name", nullptr},
	{"P", nullptr, "Pause_When_Done"},
	{"Q", "Quality", nullptr},
	{"RFI", nullptr, "Radiosity_From_File"},
	{"RFO", nullptr, "Radiosity_To_File"},
	{"RF", "Radiosity_File_Name", nullptr},
	{"RS", "Render_Block_Step", nullptr},
	{"RP", "Render_Pattern", nullptr},
	{"RTR", nullptr, "Real_Time_Raytracing"},
	{"RVP", nullptr, "Radiosity_Vain_Pretrace"},
	{"R", "Antialias_Depth", nullptr},
	{"SC", "Start_Column", nullptr},
	{"SF", "Subset_Start_Frame", nullptr},
	{"SP", "Preview_Start_Size", nullptr},
	{"SR", "Start_Row", nullptr},
	{"STP", "Frame_Step", nullptr},
	{"SU", nullptr, "Split_Unions"},
	{"TH", "Dither_Method", "Dither"},
	{"TH", nullptr, "Dither"},
	{"UA", nullptr, "Output_Alpha"},
	{"UD", nullptr, "Draw_Vistas"},
	{"UF", nullptr, "Field_Render"},
	{"UL", nullptr, "Light_Buffer"},
	{"UO", nullptr, "Odd_Field"},
	{"UR", nullptr, "Remove_Bounds"},
	{"UV", nullptr, "Vista_Buffer"},
	{"V", nullptr, "Verbose"},
	{"WL", "Warning_Level", nullptr},
	{"WT", "Work_Threads", nullptr},
	{"W", "Width", nullptr},
	{"X", "Test_Abort_Count", "Test_Abort"},
	{"X", nullptr, "Test_Abort"},
};

} // namespace

std::vector<Setting> settings_of_switch(const std::string& text, bool on) {
	for (const Switch& s : switches) {
		size_t length = 0;
		while (s.name[length] && length < text.size() && std::toupper(static_cast<unsigned char>(text[length])) == s.name[length])
			++length;
		const std::string value = text.substr(length);
		if (s.name[length] || value.empty() != (s.value == nullptr))
			continue;
		std::vector<Setting> found;
		if (s.truth)
			found.emplace_back(s.truth, on ? "On" : "Off");
		if (s.value) {
			// +FN16 is a type and a depth.
			if (std::string(s.value) == "Output_File_Type") {
				found.emplace_back(s.value, value.substr(0, 1));
				size_t bits = value.size() > 1 && std::tolower(static_cast<unsigned char>(value[1])) == 'g' ? 2 : 1;
				if (bits == 2)
					found.emplace_back("Grayscale_Output", "On");
				if (bits < value.size())
					found.emplace_back("Bits_Per_Color", value.substr(bits));
			} else {
				found.emplace_back(s.value, value);
			}
		}
		return found;
	}
	throw Error(std::string("POV-Ray has no switch '") + (on ? "+" : "-") + text + "'");
}

} // namespace farm
