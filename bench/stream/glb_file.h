// Files to upload: the built-in scenes as GLB, made into others, and sent.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "tests/e2e/raw_client.h"

namespace caustream::bench {

std::string builtinGlb(std::string_view scene);   // Throws Error when there is none such.

// The same scene with another hash: an unknown chunk behind the known ones, which GLB allows, with `salt` in it.
std::string salted(const std::string& glb, std::uint64_t salt);

std::string sha256(const std::string& bytes);

// A whole upload, minding the credit; the reply to asset.end, or the first error. Null once the server has closed.
protocol::Json upload(e2e::RawClient& client, const std::string& file, std::size_t chunkBytes = 200'000);

}  // namespace caustream::bench
