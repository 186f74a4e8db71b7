// SPDX-License-Identifier: AGPL-3.0-or-later
/// What reading and writing by libpng have in common.
#ifndef FARM_LIBPNG_H
#define FARM_LIBPNG_H

#include "distribute/common/error.h"

#include <png.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace farm::png {

/// libpng lets an error function leave by an exception (libpng-manual, "Error handling"). The error pointer is the file's name.
[[noreturn]] inline void fail(png_structp png, png_const_charp message) {
	const std::string& name = *static_cast<const std::string*>(png_get_error_ptr(png));
	if (std::string_view(message) == "Write Error") // the system's own reason is better
		throw system_error("cannot write " + name);
	throw Error(name + ": " + message);
}
inline void hush(png_structp, png_const_charp) {}

struct Closer {
	void operator()(std::FILE* f) const { std::fclose(f); }
};
using File = std::unique_ptr<std::FILE, Closer>;

} // namespace farm::png
#endif
