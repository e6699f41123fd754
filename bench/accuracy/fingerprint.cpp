#include "bench/accuracy/fingerprint.h"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "error.h"

namespace caustream::bench {

std::string fingerprint(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash);
    return text;
}

std::string buildFingerprint() {
    std::ifstream self("/proc/self/exe", std::ios::binary);
    if (!self) throw Error("cannot read /proc/self/exe, to tell this build from others; is /proc mounted?");
    return fingerprint(std::string{std::istreambuf_iterator<char>(self), {}});
}

}  // namespace caustream::bench
