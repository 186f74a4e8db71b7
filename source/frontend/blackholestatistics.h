// SPDX-License-Identifier: AGPL-3.0-or-later
/// Prints the back end's lines about holes into the statistics block.
#ifndef POVRAY_BLACKHOLESTATISTICS_H
#define POVRAY_BLACKHOLESTATISTICS_H

#include <vector>

#include "base/povms.h"
#include "base/textstreambuffer.h"
#include "backend/blackhole/options.h"

namespace pov_frontend
{

/// msg: the statistics message; nothing is printed where it has no lines of ours.
inline void Print_Blackhole_Statistics(POVMSObjectPtr msg, pov_base::TextStreamBuffer *tsb)
{
	int length = 0;
	if((POVMSUtil_GetStringLength(msg, kPOVAttrib_BlackholeStatistics, &length) != kNoErr) || (length <= 0))
		return;
	std::vector<char> text(length + 1);
	if(POVMSUtil_GetString(msg, kPOVAttrib_BlackholeStatistics, &text[0], &length) == kNoErr)
		tsb->printf("%s", &text[0]);
}

}

#endif
