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
	const auto at = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
	for (size_t i = 0; i < text.size(); ++i)
		if (at(i) == 0xc2 && at(i + 1) >= 0x80 && at(i + 1) < 0xa0) // in UTF-8, what 27 and a letter mean too
			text[i] = text[i + 1] = ' ';
		else if ((at(i) < ' ' && !(lines && (text[i] == '\n' || text[i] == '\t'))) || at(i) == 127)
			text[i] = ' ';
	return text;
}

} // namespace farm
