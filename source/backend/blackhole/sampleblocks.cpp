// SPDX-License-Identifier: AGPL-3.0-or-later
/// `Sample_Blocks=N`: one of each N blocks of a picture is rendered, so that a small part of the work tells of the whole.
#include <cstdlib>
#include <string>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/scene/scene.h"
#include "base/stringutilities.h"
#include "backend/blackhole/blackholes.h"
#include "backend/blackhole/options.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

bool Blackholes::Sample_Blocks(POVMS_Object& options, const SceneData& scene, unsigned int blocks, std::set<unsigned int>& skipped)
{
	const std::string given = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_SampleBlocks, ""));
	if(given.empty())
		return false;
	char *end = NULL;
	const long every = strtol(given.c_str(), &end, 10);
	if((*end != 0) || (every < 1) || (every > 1000000000))
		throw POV_EXCEPTION(kParamErr, "Sample_Blocks=" + given + ": must be a whole number; of so many blocks one is rendered");
	unsigned int random = 1;
	for(unsigned int first = 0; first < blocks; first += (unsigned int)every)
	{
		random = random * 1664525u + 1013904223u; // Numerical Recipes' generator; its high bits are good enough to choose by
		const unsigned int chosen = first + (unsigned int)((double(random) / 4294967296.0) * every);
		for(unsigned int i = first; (i < first + (unsigned int)every) && (i < blocks); i++)
			if(i != chosen)
				skipped.insert(i);
	}
	// Radiosity's pretrace is of the whole picture all the same.
	return !scene.radiositySettings.radiosityEnabled;
}

}
