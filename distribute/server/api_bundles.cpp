// SPDX-License-Identifier: AGPL-3.0-or-later
// Scenes and what they read, by SHA-256.
#include "distribute/common/error.h"
#include "distribute/common/hash.h"
#include "distribute/server/api.h"

#include <set>

namespace farm {
namespace {

std::string hash_of(const std::string& part) {
	if (!is_sha256(part))
		throw HttpError(404, "'" + part + "' is no SHA-256");
	return part;
}

} // namespace

void add_bundle_routes(Router& router, Farm& farm) {
	// The list first; the answer says which files are still to come.
	router.add(
		"POST", "/v1/bundles",
		[&farm](Request& r) -> Awaitable<Response> {
			const Bundle bundle = parse_object(r.body).get<Bundle>();
			auto keep = [&farm, &bundle] { farm.files().keep_bundle(bundle); };
			co_await in_pool(farm.io(), farm.threads(), keep);
			std::set<std::string> missing;
			for (const auto& file : bundle.files)
				if (!farm.files().has_file(file.sha256))
					missing.insert(file.sha256);
			co_return answer({{"bundle", bundle.id()}, {"missing", missing}}, 201);
		},
		limits::message_bytes);
	router.add("GET", "/v1/bundles/*", [&farm](Request& r) -> Awaitable<Response> {
		const auto bundle = farm.files().bundle(hash_of(r.parts[0]));
		if (!bundle)
			throw HttpError(404, "there is no bundle " + r.parts[0]);
		co_return answer(*bundle);
	});
	router.add(
		"PUT", "/v1/files/*",
		[&farm](Request& r) -> Awaitable<Response> {
			const std::string hash = hash_of(r.parts[0]);
			auto keep = [&farm, &r, &hash] { farm.files().keep_file(r.file, hash); };
			co_await in_pool(farm.io(), farm.threads(), keep);
			co_return answer(json::object(), 201);
		},
		limits::file_bytes, Body::file);
	router.add("GET", "/v1/files/*", [&farm](Request& r) -> Awaitable<Response> {
		Response file;
		file.type = "application/octet-stream";
		file.file = farm.files().file(hash_of(r.parts[0]));
		co_return file;
	});
}

} // namespace farm
