// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/client/claim.h"

#include "distribute/common/error.h"
#include "distribute/common/hash.h"

#include <fcntl.h>
#include <unistd.h>

namespace farm {

// One byte of the book stands for each file, where the hash of its path says: nothing is left behind, whoever is killed.
Claim::Claim(const std::filesystem::path& book, const std::filesystem::path& file)
	: descriptor(::open(book.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
	if (descriptor < 0)
		throw system_error("cannot write " + book.string());
	std::error_code unknown;
	const auto canonical = std::filesystem::weakly_canonical(file.parent_path(), unknown) / file.filename();
	struct flock lock {};
	lock.l_type = F_WRLCK;
	lock.l_whence = SEEK_SET;
	lock.l_start = static_cast<off_t>(std::stoull(sha256(canonical.string()).substr(0, 15), nullptr, 16));
	lock.l_len = 1;
	if (::fcntl(descriptor, F_OFD_SETLK, &lock) != 0) {
		const bool taken = errno == EAGAIN || errno == EACCES;
		const Error why = system_error("cannot lock " + book.string());
		::close(descriptor);
		throw taken
			? Error("another bhfarm render is at work on " + file.string() + ": wait for it, or name other files (+O, --video)")
			: why;
	}
}

Claim::~Claim() { ::close(descriptor); }

} // namespace farm
