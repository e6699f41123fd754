#include "session/random_id.h"

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

}  // namespace caustream::session
