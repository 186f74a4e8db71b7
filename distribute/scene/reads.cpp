// SPDX-License-Identifier: AGPL-3.0-or-later
// Loaded before povray's libraries during a dry parse: notes each file that is opened for reading, in the file that BHFARM_READS
// names. A file of POV-Ray's own knows all that, but a hook there would cost more lines than this.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace {

void note(const char* name, const char* mode, const void* opened) {
	static const char* const list = std::getenv("BHFARM_READS");
	if (!list || !name || !opened || mode[0] != 'r' || std::strchr(mode, '+'))
		return;
	const int d = ::open(list, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
	if (d < 0)
		return;
	const std::string line = std::string(name) + "\n"; // one write: threads do not mix
	if (::write(d, line.data(), line.size()) < 0) {
	} // the list stays short, and a file is missed at the first worker
	::close(d);
}

using Open = FILE* (*)(const char*, const char*);

} // namespace

extern "C" {

FILE* fopen(const char* name, const char* mode) {
	static const auto next = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "fopen"));
	FILE* f = next(name, mode);
	note(name, mode, f);
	return f;
}

FILE* fopen64(const char* name, const char* mode) {
	static const auto next = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "fopen64"));
	FILE* f = next(name, mode);
	note(name, mode, f);
	return f;
}
}
