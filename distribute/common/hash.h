// SPDX-License-Identifier: AGPL-3.0-or-later
/// SHA-256, by which the farm names files, and other uses of OpenSSL's libcrypto.
#ifndef FARM_HASH_H
#define FARM_HASH_H

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace farm {

/// Of data that comes piece by piece.
class Sha256 {
public:
	Sha256();
	void add(std::string_view data);
	/// 64 lower-case hexadecimal digits. Nothing may be added after that.
	std::string name();

private:
	std::shared_ptr<void> context;
};

/// 64 lower-case hexadecimal digits.
std::string sha256(std::string_view data);
/// Likewise of a file's content; throws Error if it cannot be read.
std::string sha256_file(const std::filesystem::path& file);
/// Whether a string has the form of such a name.
bool is_sha256(std::string_view text);

/// So many random bytes from the system, as hexadecimal digits: tokens, workers' names.
std::string random_hex(int bytes);
/// Whether two secrets are equal, in a time that tells nothing about where they differ.
bool same_secret(std::string_view a, std::string_view b);

} // namespace farm
#endif
