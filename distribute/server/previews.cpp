// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/server/previews.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"

#include <algorithm>

namespace farm {

std::vector<Previews::Source> Previews::sources(const Job& job, int index) const {
	const JobSpec& spec = job.row.spec;
	const int per = spec.strips_per_frame();
	std::vector<Source> list;
	for (int s = index * per; s < (index + 1) * per; ++s)
		if (const auto file = farm.settled_strip(job.row.id, s))
			list.push_back({*file, spec.row_of(s), spec.rows_of(s)});
	// Its strips go when the job is over; the frame stays.
	if (list.empty() && job.stitched[static_cast<size_t>(index)])
		list.push_back({farm.files().frame(job.row.id, spec.picture(spec.frame(index))), 0, spec.height});
	return list;
}

std::string Previews::make(const Key& key, const JobSpec& spec, const std::vector<Source>& list) {
	auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
	const auto there = [&](const fs::path& file) {
		return std::any_of(list.begin(), list.end(), [&](const Source& s) { return s.file == file; });
	};
	// A strip that it shows may have turned out to be wrong.
	if (entry != entries.end() && !std::all_of(entry->in.begin(), entry->in.end(), there)) {
		bytes -= entry->preview.bytes() + entry->png.size();
		entries.erase(entry);
		entry = entries.end();
	}
	if (entry == entries.end())
		entries.push_front({key, {}, Preview(spec.width, spec.height, key.size), ""});
	else
		entries.splice(entries.begin(), entries, entry);
	Entry& e = entries.front();
	bytes -= e.in.empty() && e.png.empty() ? 0 : e.preview.bytes() + e.png.size();
	try {
		for (const Source& source : list)
			if (std::find(e.in.begin(), e.in.end(), source.file) == e.in.end()) {
				e.preview.add(spec.format, source.file, source.row, source.rows);
				e.in.push_back(source.file);
				e.png.clear();
			}
		if (e.png.empty())
			e.png = e.preview.png();
	} catch (...) { // half a strip may be in it
		entries.pop_front();
		throw;
	}
	std::string png = e.png;
	bytes += e.preview.bytes() + e.png.size();
	while (bytes > most_bytes && entries.size() > 1) {
		bytes -= entries.back().preview.bytes() + entries.back().png.size();
		entries.pop_back();
	}
	return png;
}

Awaitable<Response> Previews::get(JobId id, int frame, int size, std::string etag) {
	const Job& job = farm.job(id);
	const JobSpec spec = job.row.spec;
	if (frame < spec.first || frame > spec.last || (frame - spec.first) % spec.step != 0)
		throw HttpError(404, "job " + std::to_string(id) + " has no frame " + std::to_string(frame));
	const Key key{id, (frame - spec.first) / spec.step, size};
	const auto list = sources(job, key.index);
	std::string names = std::to_string(size);
	for (const Source& s : list)
		names += s.file.filename().string() + "\n";
	Response answer;
	answer.type = "image/png";
	answer.headers["Cache-Control"] = "private, no-cache";
	answer.headers["ETag"] = '"' + sha256(names).substr(0, 32) + '"';
	if (etag == answer.headers["ETag"]) {
		answer.status = 304;
		co_return answer;
	}
	auto work = [this, key, spec, list] { return make(key, spec, list); };
	try {
		answer.body = co_await in_pool(farm.io(), thread, std::move(work));
	} catch (const Error&) { // the job has ended or been removed meanwhile
		throw HttpError(404, "frame " + std::to_string(frame) + " of job " + std::to_string(id) + " changes; ask again");
	}
	co_return answer;
}

} // namespace farm
