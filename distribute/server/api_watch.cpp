// SPDX-License-Identifier: AGPL-3.0-or-later
// What those ask who watch: how things stand, from now on; and pictures as they come.
#include "distribute/common/arguments.h"
#include "distribute/server/api.h"
#include "distribute/server/previews.h"

namespace farm {
namespace {

std::string piece(const std::string& text) {
	std::string line("data: ");
	line.append(text).append("\n\n");
	return line;
}

std::string everything(const Farm& farm) { return piece(answer(describe_all(farm)).body); }

Awaitable<void> stream_events(Farm& farm, Sink& sink) {
	Events::Watch watch(farm.news());
	std::string text("retry: 2000\n\n");
	text += everything(farm);
	while (co_await sink.write(std::move(text))) {
		const Events::Text news = co_await watch.next(15);
		if (watch.missed())
			text = everything(farm);
		else if (news)
			text = piece(*news);
		else // shows that both ends are there
			text = piece(answer({{"event", "time"}, {"time", wall_time()}}).body);
	}
}

} // namespace

void add_watch_routes(Router& router, Farm& farm) {
	farm.news().speak([&farm](const Touched& touched) { return describe(farm, touched); });
	router.add("GET", "/v1/events", [&farm](Request&) -> Awaitable<Response> {
		Response news;
		news.type = "text/event-stream";
		news.headers["Cache-Control"] = "no-store";
		news.stream = [&farm](Sink& sink) { return stream_events(farm, sink); };
		co_return news;
	});
	router.add("GET", "/v1/jobs/*/strips", [&farm](Request& r) -> Awaitable<Response> {
		const Job& job = farm.job(id_of(r.parts[0], "job"));
		json frames = json::array();
		for (size_t i = 0; i < job.stitched.size(); ++i)
			if (job.stitched[i])
				frames.push_back(job.row.spec.frame(static_cast<int>(i)));
		co_return answer({{"strips", strip_letters(farm, job)}, {"frames_done", frames}});
	});
	const auto previews = std::make_shared<Previews>(farm);
	router.add("GET", "/v1/jobs/*/preview/*", [previews](Request& r) -> Awaitable<Response> {
		const auto frame = static_cast<int>(whole_number(r.parts[1], "the frame", INT32_MIN, INT32_MAX));
		const auto size = static_cast<int>(whole_number(r.asked("size", "320"), "size", 1, 1024));
		const auto known = r.headers.find("if-none-match");
		std::string etag = known == r.headers.end() ? "" : known->second;
		co_return co_await previews->get(id_of(r.parts[0], "job"), frame, size, std::move(etag));
	});
}

} // namespace farm
