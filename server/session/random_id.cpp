#include "session/random_id.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <array>
#include <string_view>

#include "error.h"

namespace caustream::session {

std::string hex(std::span<const unsigned char> bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : bytes) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

std::string randomId() {
    std::array<unsigned char, 16> bytes{};
    if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
        throw Error("random numbers are not available; check the installation of libcrypto");
    }
    return hex(bytes);
}

bool isId(std::string_view text) {
    return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::string viewIdOf(std::string_view session) {
    const std::string text = "caustream view " + std::string(session);
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    if (EVP_Digest(text.data(), text.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
        throw Error("SHA-256 is not available; check the installation of libcrypto");
    }
    return hex({digest.data(), 16});
}

}  // namespace caustream::session
