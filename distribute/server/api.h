// SPDX-License-Identifier: AGPL-3.0-or-later
/// The farm's requests. docs/PROTOCOL.md describes each.
#ifndef FARM_API_H
#define FARM_API_H

#include "distribute/http/router.h"
#include "distribute/server/farm.h"

namespace farm {

/// Each adds its routes; the farm outlives the router.
void add_job_routes(Router& router, Farm& farm);
void add_worker_routes(Router& router, Farm& farm);
void add_bundle_routes(Router& router, Farm& farm);

/// What people and machines are told of a job and of a worker.
json describe(const Farm& farm, const Job& job);
json describe(const Farm& farm, const Guest& guest);

Response answer(const json& body, int status = 200);
/// A path's part as an id; throws HttpError 404.
std::int64_t id_of(const std::string& part, const char* what);

} // namespace farm
#endif
