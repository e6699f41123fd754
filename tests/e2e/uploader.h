// Files and the chunks they are sent in.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "raw_client.h"

namespace caustream::e2e {

std::string builtinGlb(std::string_view name);  // empty: there is none

std::string sha256(std::string_view bytes);

// `file` with an unknown chunk of `bytes` behind the known ones, which a GLB may have.
std::string padded(std::string file, std::uint32_t bytes);

std::vector<std::uint8_t> chunkOf(std::uint32_t asset, std::string_view file, std::size_t offset, std::size_t size);

Json beginUpload(RawClient& viewer, std::string_view file, const std::string& hash);

// Sends what `offer`, the reply to asset.begin, leaves to send, minding the credit.
void sendChunks(RawClient& viewer, std::string_view file, const Json& offer);

// All of it; the reply to asset.end.
Json upload(RawClient& viewer, std::string_view file, const std::string& hash);
Json upload(RawClient& viewer, std::string_view file);

}  // namespace caustream::e2e
