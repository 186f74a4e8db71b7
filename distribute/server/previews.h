// SPDX-License-Identifier: AGPL-3.0-or-later
/// Small pictures of frames for those who watch: what has come of a frame so far, in its place.
#ifndef FARM_PREVIEWS_H
#define FARM_PREVIEWS_H

#include "distribute/server/farm.h"
#include "distribute/stitch/preview.h"

#include <list>

namespace farm {

/// Keeps the latest ones, so that a frame that fills in costs its new strips only. They are made on one thread of their own:
/// watchers do not hold up the work.
class Previews {
public:
	explicit Previews(Farm& f) : farm(f) {}
	~Previews() {
		thread.stop();
		thread.join();
	}
	/// The preview of POV-Ray's frame `frame`, its longer side `size` pixels; 304 to a request that has it already. Throws
	/// HttpError 404 where there is no such frame.
	Awaitable<Response> get(JobId job, int frame, int size, std::string etag);

private:
	struct Key {
		JobId job;
		int index, size;
		bool operator==(const Key& o) const { return job == o.job && index == o.index && size == o.size; }
	};
	struct Source {
		fs::path file;
		int row, rows;
	};
	struct Entry {
		Key key;
		std::vector<fs::path> in; ///< those of its sources it shows
		Preview preview;
		std::string png;
	};
	std::vector<Source> sources(const Job& job, int index) const;
	/// In the thread, as all that follows.
	std::string make(const Key& key, const JobSpec& spec, const std::vector<Source>& sources);

	static constexpr size_t most_bytes = 64 << 20;
	Farm& farm;
	boost::asio::thread_pool thread{1};
	std::list<Entry> entries; ///< the latest first
	size_t bytes = 0;
};

} // namespace farm
#endif
