// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/control/messagefactory.h"
#include "base/fileinputoutput.h"
#include "base/stringutilities.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/options.h"
#include "backend/blackhole/raypaths.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

static bool Ends_With(const std::string& s, const char *end)
{
	return (s.size() > strlen(end)) && (s.compare(s.size() - strlen(end), std::string::npos, end) == 0);
}

Ray_Paths *Ray_Paths::Create(POVMS_Object& options)
{
	const std::string file = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_RayPaths, ""));
	const std::string grid = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_RayPathsGrid, "32x24"));
	if(file.empty())
		return NULL;
	if(!Ends_With(file, ".csv") && !Ends_With(file, ".wrl"))
		throw POV_EXCEPTION(kParamErr, "Ray_Paths=" + file + ": the file's name must end in .csv or .wrl");
	std::unique_ptr<Ray_Paths> paths(new Ray_Paths());
	char rest;
	if((sscanf(grid.c_str(), "%dx%d%c", &paths->columns, &paths->rows, &rest) != 2) ||
	   (paths->columns < 1) || (paths->rows < 1) || (paths->columns > 10000) || (paths->rows > 10000))
		throw POV_EXCEPTION(kParamErr, "Ray_Paths_Grid=" + grid + ": must be rays across x rays down, as in 32x24");
	paths->file = file;
	// Now, not when the picture is done.
	if(FILE *f = fopen(file.c_str(), "a"))
		fclose(f);
	else
		throw POV_EXCEPTION(kParamErr, "Ray_Paths=" + file + ": cannot write there");
	return paths.release();
}

// Grid cells' middles fall on these pixels.
static bool On_Grid(DBL pixel, DBL size, int cells)
{
	if(cells >= size)
		return true;
	const DBL cell = floor(pixel * cells / size);
	for(DBL c = cell - 1.0; c <= cell + 1.0; c++)
		if(floor((c + 0.5) * size / cells) == pixel)
			return true;
	return false;
}

bool Ray_Paths::Wants(DBL x, DBL y, DBL width, DBL height) const
{
	return On_Grid(floor(x), width, columns) && On_Grid(floor(y), height, rows);
}

void Ray_Paths::Keep(int x, int y, Recorded_Pixel& pixel)
{
	boost::mutex::scoped_lock lock(mutex);
	Recorded_Pixel& kept = pixels[std::make_pair(y, x)];
	if(kept.empty())
		kept.swap(pixel);
}

std::string Ray_Paths::Csv() const
{
	std::string out("column,row,ray,level,chord,hole,x0,y0,z0,x1,y1,z1,tested,end,drift\n");
	char text[512];
	std::map<std::pair<int, int>, Recorded_Pixel>::const_iterator p;
	for(p = pixels.begin(); p != pixels.end(); ++p)
		for(size_t r = 0; r < p->second.size(); r++)
		{
			const Recorded_Ray& ray = p->second[r];
			for(size_t c = 0; c < ray.Chords.size(); c++)
			{
				const Recorded_Ray::Chord& k = ray.Chords[c];
				const bool last = (c + 1 == ray.Chords.size());
				char drift[32] = "";
				if(last)
					snprintf(drift, sizeof drift, "%.3g", ray.Drift);
				snprintf(text, sizeof text, "%d,%d,%d,%u,%d,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d,%s,%s\n",
				         p->first.second, p->first.first, int(r), ray.Level, int(c), k.Hole,
				         k.From.x, k.From.y, k.From.z, k.To.x, k.To.y, k.To.z, int(k.Tested), last ? ray.End : "", drift);
				out += text;
			}
		}
	return out;
}

static const char *Colour_Of(const char *end)
{
	if(strcmp(end, "horizon") == 0)
		return "0.9 0.2 0.1";
	if(strcmp(end, "object") == 0)
		return "0.2 0.7 0.3";
	return "0.3 0.5 0.9";
}

// VRML is right-handed, POV-Ray is left-handed: z changes its sign.
std::string Ray_Paths::Vrml(const Blackholes& holes) const
{
	std::string out("#VRML V2.0 utf8\n# Ray paths: blue to the sky, green to an object, red into the horizon.\n");
	char text[512];
	for(size_t h = 0; h < holes.Holes().size(); h++)
	{
		const Blackhole& hole = *holes.Holes()[h];
		snprintf(text, sizeof text, "Transform { translation %.9g %.9g %.9g children Shape { appearance Appearance { material Material { diffuseColor 0 0 0 } } geometry Sphere { radius %.9g } } }\n",
		         hole.Center[X], hole.Center[Y], -hole.Center[Z], hole.Radius);
		out += text;
	}
	std::map<std::pair<int, int>, Recorded_Pixel>::const_iterator p;
	for(p = pixels.begin(); p != pixels.end(); ++p)
		for(size_t r = 0; r < p->second.size(); r++)
		{
			const Recorded_Ray& ray = p->second[r];
			if(ray.Chords.empty())
				continue;
			snprintf(text, sizeof text, "Shape { appearance Appearance { material Material { emissiveColor %s } } geometry IndexedLineSet { coord Coordinate { point [",
			         Colour_Of(ray.End));
			out += text;
			snprintf(text, sizeof text, " %.9g %.9g %.9g", ray.Chords[0].From.x, ray.Chords[0].From.y, -ray.Chords[0].From.z);
			out += text;
			for(size_t c = 0; c < ray.Chords.size(); c++)
			{
				const blackhole::Vec3& to = ray.Chords[c].To;
				snprintf(text, sizeof text, ", %.9g %.9g %.9g", to.x, to.y, -to.z);
				out += text;
			}
			out += " ] } coordIndex [";
			for(size_t c = 0; c <= ray.Chords.size(); c++)
			{
				snprintf(text, sizeof text, " %d", int(c));
				out += text;
			}
			out += " -1 ] } }\n";
		}
	return out;
}

void Ray_Paths::Write(const Blackholes& holes, MessageFactory& messages)
{
	boost::mutex::scoped_lock lock(mutex);
	const std::string text = Ends_With(file, ".csv") ? Csv() : Vrml(holes);
	// POV-Ray's own stream: it asks whether the path may be written to.
	boost::scoped_ptr<OStream> stream(NewOStream(Path(file), POV_File_Text_User, false));
	if((stream == NULL) || !stream->write(text.data(), text.size()))
		messages.Warning(1, "Ray_Paths=%s: cannot write there; the ray paths are lost.", file.c_str());
}

}
