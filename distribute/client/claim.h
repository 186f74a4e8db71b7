// SPDX-License-Identifier: AGPL-3.0-or-later
/// So that no two renders write the same files.
#ifndef FARM_CLAIM_H
#define FARM_CLAIM_H

#include <filesystem>

namespace farm {

/// A file, or what shares its name, is this process's to write, for as long as this lives; the kernel gives it up when the
/// process dies.
class Claim {
public:
	/// `book` is a file that all who are to know of each other have in common; it stays empty. Throws Error if `file` is taken.
	Claim(const std::filesystem::path& book, const std::filesystem::path& file);
	~Claim();
	Claim(const Claim&) = delete;
	Claim& operator=(const Claim&) = delete;

private:
	int descriptor;
};

} // namespace farm
#endif
