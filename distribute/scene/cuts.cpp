// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/scene/cuts.h"

#include <algorithm>

namespace farm {
namespace {

/// povray traces whole blocks of so many rows; cuts elsewhere would trace some twice.
constexpr int block = 32;

/// Half a minute at most, that there is something to see and little to lose.
constexpr double longest = 30;

/// What is not a whole frame is written and read as one, and packed a second time: seconds a strip.
double cut_seconds(const JobSpec& spec) {
	constexpr double million_pixels = 0.13; // as measured, with a film of 1280 x 720
	return million_pixels * 1e-6 * spec.width * spec.height;
}

/// Seconds for a job of equal strips, when frames are cut to so many. Beside its pixels each strip costs povray's start, the way
/// to the server and a parse; radiosity's pretrace is done anew on each machine. At the job's end slots wait for the last strips,
/// half of one each, but for the one that renders it.
double job_seconds(const JobSpec& spec, const Gathered& files, int slots, int count) {
	constexpr double start = 0.07; // as measured
	const double cut = count > 1 ? cut_seconds(spec) : 0;
	const double strip = files.frame_seconds / count + start + cut + files.parse_seconds + files.light_seconds;
	return std::max(strip, strip * count * spec.frames() / slots + 0.5 * (1 - 1.0 / slots) * strip);
}

/// The count of strips a frame for which a job is done first. Where there are enough strips for all slots, parsing is a twentieth
/// of a strip's time at most: others may wait for the slots.
int best_count(const JobSpec& spec, const Gathered& files, int slots, int blocks) {
	const double least = 20 * files.parse_seconds;
	const double most = std::max({longest, 20 * files.light_seconds, 20 * cut_seconds(spec), 2 * least});
	int best = 0;
	for (int count = 1; count <= blocks; ++count) {
		const double strip = files.frame_seconds / count;
		if (count > 1 && strip < least && count * spec.frames() > 2 * slots)
			break;
		const bool too_long = strip > most && count < blocks;
		if (!too_long && (best == 0 || job_seconds(spec, files, slots, count) < job_seconds(spec, files, slots, best)))
			best = count;
	}
	return std::max(1, best);
}

} // namespace

int strip_rows(const JobSpec& spec, const Gathered& files, int count, int slots) {
	if (!spec.whole_because.empty() || count == 1)
		return spec.height;
	const int blocks = (spec.height + block - 1) / block;
	if (count > blocks) // as asked for, at some cost
		return (spec.height + count - 1) / count;
	if (count == 0)
		count = best_count(spec, files, slots, blocks);
	return std::min(spec.height, (blocks + count - 1) / count * block);
}

} // namespace farm
