// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <string>
#include <vector>

// configbase.h must always be the first POV file included within base *.cpp files
#include "base/configbase.h"
#include "base/types.h"
#include "base/pov_err.h"
#include "base/povmscpp.h"
#include "base/povmsgid.h"
#include "base/stringutilities.h"
#include "frontend/configfrontend.h"
#include "backend/reproducible/options.h"
#include "frontend/pixelfile.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov_frontend
{

using namespace pov_base;

static const int Channels = 5;

struct Pixel_File
{
	const std::string key;
	FILE *file;
	Pixel_File(const char *key, const std::string& name, const char *mode) : key(key + ("=" + name)), file(fopen(name.c_str(), mode)) { if(file == NULL) Fail("cannot be opened"); }
	~Pixel_File() { if(file != NULL) fclose(file); }
	void Fail(const std::string& what) const { throw POV_EXCEPTION(kFileDataErr, key + ": " + what); }
};

// As the back end reads rows: from 1, or below 1 a part of the height.
static int Row(POVMS_Object& options, POVMSType key, int height, bool last)
{
	const double row = options.TryGetFloat(key, last ? height : 1.0);
	const bool part = (row >= 0.0) && (last ? (row <= 1.0) : (row < 1.0));
	return int((part ? height * row : row) - ((last || !part) ? 1.0 : 0.0));
}

static void Write_Pixels(POVMS_Object& options, const Image& image, const std::string& name)
{
	const int width = image.GetWidth(), height = image.GetHeight();
	const int first = Row(options, kPOVAttrib_Top, height, false), last = Row(options, kPOVAttrib_Bottom, height, true);
	Pixel_File to("Pixels_To_File", name, "wb");
	fprintf(to.file, "pixels 1 %d %d %d %d %d %a %d %a\n", width, height, first, last,
	        int(options.TryGetInt(kPOVAttrib_WorkingGammaType, DEFAULT_WORKING_GAMMA_TYPE)), options.TryGetFloat(kPOVAttrib_WorkingGamma, DEFAULT_WORKING_GAMMA),
	        int(options.TryGetInt(kPOVAttrib_FileGammaType, DEFAULT_FILE_GAMMA_TYPE)), options.TryGetFloat(kPOVAttrib_FileGamma, DEFAULT_FILE_GAMMA));
	std::vector<float> row(size_t(width) * Channels);
	for(int y = first; y <= last; y++)
	{
		for(int x = 0; x < width; x++)
		{
			float *p = &row[size_t(x) * Channels];
			image.GetRGBFTValue(x, y, p[0], p[1], p[2], p[3], p[4]);
		}
		fwrite(&row[0], sizeof(float), row.size(), to.file);
	}
	const bool whole = !ferror(to.file) && (fclose(to.file) == 0);
	to.file = NULL;
	if(!whole)
		to.Fail("cannot be written to its end");
}

static void Read_Pixels(POVMS_Object& options, Image& image, const std::string& name)
{
	const int width = image.GetWidth(), height = image.GetHeight();
	const std::string size = std::to_string(width) + "x" + std::to_string(height);
	Pixel_File from("Pixels_From_File", name, "rb");
	std::vector<bool> there(height, false);
	std::vector<float> row(size_t(width) * Channels);
	char line[300];
	while(fgets(line, sizeof(line), from.file) != NULL)
	{
		int w, h, first, last, working_type, file_type;
		float working, file;
		if(sscanf(line, "pixels 1 %d %d %d %d %d %a %d %a", &w, &h, &first, &last, &working_type, &working, &file_type, &file) != 8)
			from.Fail("no such file as Pixels_To_File writes");
		if((w != width) || (h != height))
			from.Fail("rows of a picture of " + std::to_string(w) + "x" + std::to_string(h) + "; this one is " + size);
		options.SetInt(kPOVAttrib_WorkingGammaType, working_type);
		options.SetFloat(kPOVAttrib_WorkingGamma, working);
		options.SetInt(kPOVAttrib_FileGammaType, file_type);
		options.SetFloat(kPOVAttrib_FileGamma, file);
		for(int y = first; y <= last; y++)
		{
			if((y < 0) || (y >= height) || (fread(&row[0], sizeof(float), row.size(), from.file) != row.size()))
				from.Fail("ends in row " + std::to_string(y + 1) + " of rows " + std::to_string(first + 1) + " to " + std::to_string(last + 1));
			there[y] = true;
			for(int x = 0; x < width; x++)
			{
				const float *p = &row[size_t(x) * Channels];
				image.SetRGBFTValue(x, y, p[0], p[1], p[2], p[3], p[4]);
			}
		}
	}
	for(int y = 0; y < height; y++)
		if(!there[y])
			from.Fail("row " + std::to_string(y + 1) + " of " + std::to_string(height) + " is missing");
}

void Move_Pixels(POVMS_Object& options, Image& image)
{
	const std::string to = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_PixelsToFile, ""));
	const std::string from = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_PixelsFromFile, ""));
	if(!from.empty())
		Read_Pixels(options, image, from);
	if(!to.empty())
		Write_Pixels(options, image, to);
}

}
