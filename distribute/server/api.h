// SPDX-License-Identifier: AGPL-3.0-or-later
/// The farm's requests. docs/PROTOCOL.md describes each.
#ifndef FARM_API_H
#define FARM_API_H

#include "distribute/http/door.h"
#include "distribute/http/router.h"
#include "distribute/server/farm.h"

namespace farm {

/// Each adds its routes; the farm outlives the router.
void add_job_routes(Router& router, Farm& farm);
void add_worker_routes(Router& router, Farm& farm);
void add_bundle_routes(Router& router, Farm& farm);
void add_watch_routes(Router& router, Farm& farm);

/// Likewise with who stands at the door.
void add_page_routes(Router& router, Door& door);
/// The way in for browsers; `word`, if any, says what went wrong. No text of strangers.
Response sign_in_page(const std::string& word = "");

/// What people and machines are told of a job and of a worker.
json describe(const Farm& farm, const Job& job);
json describe(const Farm& farm, const Guest& guest);
/// What a watcher is told: first everything, then what has changed.
json describe_all(const Farm& farm);
json describe(const Farm& farm, const Touched& touched);
/// How a strip stands: w waits, o is out, s is settled, x was given up; r and a: waits or is out again.
char strip_letter(const Farm& farm, const Job& job, int strip);
/// One a strip, frame by frame.
std::string strip_letters(const Farm& farm, const Job& job);

Response answer(const json& body, int status = 200);
/// A path's part as an id; throws HttpError 404.
std::int64_t id_of(const std::string& part, const char* what);

} // namespace farm
#endif
