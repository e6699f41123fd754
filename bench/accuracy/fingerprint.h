// Short names for long inputs, so that a result is never taken for another input's.
#pragma once
#include <string>
#include <string_view>

namespace caustream::bench {

// FNV-1a of the bytes, 16 hex digits. Fowler, Noll & Vo; not against an adversary.
std::string fingerprint(std::string_view bytes);

// Of the running program's own file: another build is another fingerprint. Throws Error where it cannot be read.
std::string buildFingerprint();

}  // namespace caustream::bench
