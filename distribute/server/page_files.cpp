// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/server/page_files.h"

#include <stdexcept>

// The assembler takes the file in as it is; C++20 has no word for that.
asm(".section .rodata\n"
	".global farm_source_begin\n"
	".global farm_source_end\n"
	"farm_source_begin:\n"
	".incbin \"" FARM_SOURCE_ARCHIVE "\"\n"
	"farm_source_end:\n"
	".byte 0\n"
	".previous\n");
extern "C" const char farm_source_begin[], farm_source_end[];

namespace farm {

const PageFile& page_file(std::string_view name) {
	for (const PageFile& file : page_files)
		if (file.name == name)
			return file;
	throw std::out_of_range("the page has no such file");
}

std::string_view source_archive() { return {farm_source_begin, static_cast<size_t>(farm_source_end - farm_source_begin)}; }

} // namespace farm
