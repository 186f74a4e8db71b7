// SPDX-License-Identifier: AGPL-3.0-or-later
/// What is built into the server's binary: the page to watch, and the source of all this.
#ifndef FARM_PAGE_FILES_H
#define FARM_PAGE_FILES_H

#include <string_view>
#include <vector>

namespace farm {

/// A file of distribute/web.
struct PageFile {
	std::string_view name, type, etag, body;
};
extern const std::vector<PageFile> page_files;
/// Throws std::out_of_range.
const PageFile& page_file(std::string_view name);

/// The repository's files as they were built, as tools/source packs them: a .tar.gz.
std::string_view source_archive();

} // namespace farm
#endif
