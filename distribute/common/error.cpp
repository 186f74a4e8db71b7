// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace farm {
namespace {
std::string program = "bhfarm";
bool stamped = false;
} // namespace

bool Error::disk_full() const { return number == ENOSPC || number == EDQUOT; }

Error system_error(const std::string& what) {
	const int number = errno;
	return Error(what + ": " + std::strerror(number), number);
}

void name_program(const std::string& name, bool timestamps) {
	program = name;
	stamped = timestamps;
}

void say(const std::string& line) {
	char stamp[32] = "";
	if (stamped) {
		const std::time_t now = std::time(nullptr);
		std::tm local{};
		localtime_r(&now, &local);
		std::strftime(stamp, sizeof stamp, "%H:%M:%S ", &local);
	}
	std::fprintf(stderr, "%s%s: %s\n", stamp, program.c_str(), for_terminal(line).c_str());
}

std::string for_terminal(std::string text, bool lines) {
	for (char& c : text)
		if ((static_cast<unsigned char>(c) < ' ' && !(lines && (c == '\n' || c == '\t'))) || c == 127)
			c = ' ';
	return text;
}

} // namespace farm
