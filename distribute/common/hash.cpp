// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/hash.h"

#include "distribute/common/error.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

namespace farm {
namespace {

std::string hex(const unsigned char* bytes, size_t count) {
	static const char digits[] = "0123456789abcdef";
	std::string text;
	text.reserve(2 * count);
	for (size_t i = 0; i < count; ++i) {
		text += digits[bytes[i] >> 4];
		text += digits[bytes[i] & 15];
	}
	return text;
}

EVP_MD_CTX* at(const std::shared_ptr<void>& context) { return static_cast<EVP_MD_CTX*>(context.get()); }

} // namespace

Sha256::Sha256() : context(EVP_MD_CTX_new(), [](void* c) { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(c)); }) {
	EVP_DigestInit_ex(at(context), EVP_sha256(), nullptr);
}

void Sha256::add(std::string_view data) { EVP_DigestUpdate(at(context), data.data(), data.size()); }

std::string Sha256::name() {
	unsigned char bytes[EVP_MAX_MD_SIZE];
	unsigned count = 0;
	EVP_DigestFinal_ex(at(context), bytes, &count);
	return hex(bytes, count);
}

std::string sha256(std::string_view data) {
	Sha256 digest;
	digest.add(data);
	return digest.name();
}

std::string sha256_file(const std::filesystem::path& file) {
	std::ifstream in(file, std::ios::binary);
	if (!in)
		throw system_error("cannot read " + file.string());
	Sha256 digest;
	std::vector<char> buffer(1 << 16);
	while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || in.gcount() > 0)
		digest.add({buffer.data(), static_cast<size_t>(in.gcount())});
	if (in.bad())
		throw system_error("cannot read " + file.string());
	return digest.name();
}

bool is_sha256(std::string_view text) {
	return text.size() == 64 &&
		   std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string random_hex(int bytes) {
	std::vector<unsigned char> random(static_cast<size_t>(bytes));
	if (RAND_bytes(random.data(), bytes) != 1)
		throw Error("the system gives no random numbers");
	return hex(random.data(), random.size());
}

bool same_secret(std::string_view a, std::string_view b) {
	// Hashes have one length, so that not even the secret's shows.
	const std::string x = sha256(a), y = sha256(b);
	return CRYPTO_memcmp(x.data(), y.data(), x.size()) == 0;
}

} // namespace farm
