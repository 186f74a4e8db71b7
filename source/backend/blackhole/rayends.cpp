// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <memory>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/control/messagefactory.h"
#include "backend/shape/csg.h"
#include "base/fileinputoutput.h"
#include "base/stringutilities.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/options.h"
#include "backend/blackhole/rayends.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

Ray_Ends *Ray_Ends::Create(POVMS_Object& options)
{
	const std::string file = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_RayEnds, ""));
	if(file.empty())
		return NULL;
	// Now, not when the picture is done.
	if(FILE *f = fopen(file.c_str(), "a"))
		fclose(f);
	else
		throw POV_EXCEPTION(kParamErr, "Ray_Ends=" + file + ": cannot write there");
	std::unique_ptr<Ray_Ends> ends(new Ray_Ends());
	ends->file = file;
	return ends.release();
}

void Ray_Ends::Keep(int x, int y, std::vector<Ray_End>& pixel)
{
	boost::mutex::scoped_lock lock(mutex);
	std::vector<Ray_End>& kept = pixels[std::make_pair(y, x)];
	if(kept.empty())
		kept.swap(pixel);
}

void Ray_Ends::Number(const std::vector<ObjectPtr>& objects)
{
	for(size_t i = 0; i < objects.size(); i++)
	{
		numbers.insert(std::make_pair(objects[i], int(numbers.size())));
		if(CSG *csg = dynamic_cast<CSG *>(objects[i]))
			Number(csg->children);
	}
}

void Ray_Ends::Write(const Blackholes& holes, MessageFactory& messages)
{
	boost::mutex::scoped_lock lock(mutex);
	// POV-Ray's own stream: it asks whether the path may be written to.
	boost::scoped_ptr<OStream> stream(NewOStream(Path(file), POV_File_Text_User, false));
	bool fine = (stream != NULL);
	char text[512];
	for(size_t h = 0; fine && (h < holes.Holes().size()); h++)
	{
		const Blackhole& hole = *holes.Holes()[h];
		const int length = snprintf(text, sizeof text, "# hole %.17g %.17g %.17g Rs %.17g effect_radius %.17g tolerance %.17g method %s\n",
		                            hole.Center[X], hole.Center[Y], hole.Center[Z], hole.Radius, hole.Reach(), hole.Tolerance,
		                            blackhole::method_names[int(hole.Method)]);
		fine = stream->write(text, length);
	}
	const std::string head("column,row,ray,level,weight,end,object,x,y,z\n");
	fine = fine && stream->write(head.data(), head.size());
	std::map<std::pair<int, int>, std::vector<Ray_End> >::const_iterator p;
	for(p = pixels.begin(); fine && (p != pixels.end()); ++p)
		for(size_t r = 0; fine && (r < p->second.size()); r++)
		{
			const Ray_End& ray = p->second[r];
			const std::map<ObjectPtr, int>::const_iterator n = numbers.find(ray.Object);
			const int length = snprintf(text, sizeof text, "%d,%d,%d,%u,%.3g,%s,%d,%.17g,%.17g,%.17g\n", p->first.second, p->first.first, int(r),
			                            ray.Level, ray.Weight, ray.End, n == numbers.end() ? -1 : n->second, ray.At.x, ray.At.y, ray.At.z);
			fine = stream->write(text, length);
		}
	pixels.clear();
	if(!fine)
		messages.Warning(1, "Ray_Ends=%s: cannot write there; the ray ends are lost.", file.c_str());
}

}
