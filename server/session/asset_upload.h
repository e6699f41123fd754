// One file on its way in: chunks in order, each checked, until the announced length and hash are met. Memory follows the
// bytes that came, never the length that was announced. Network thread only; no sockets.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "protocol/messages.h"

struct evp_md_ctx_st;

namespace caustream::session {

class AssetUpload {
   public:
    AssetUpload(std::uint32_t asset, const protocol::AssetBegin& begin, const protocol::Limits& limits);
    ~AssetUpload();

    // Errors: bad_offset (not the next byte, or beyond the announced size or the credit), asset_invalid (checksum).
    // After an error the upload stands where it stood. Gives the credit message to send, when there is one.
    tl::expected<std::optional<protocol::AssetCredit>, protocol::DecodeError> add(const protocol::ChunkHeader& header,
                                                                                  std::span<const std::uint8_t> payload);

    // The file. Errors: bytes are missing (asset_invalid, field "size"), another hash (field "sha256").
    tl::expected<std::vector<std::byte>, protocol::DecodeError> finish();

    std::uint32_t asset() const { return asset_; }
    const std::string& sha256() const { return sha256_; }
    protocol::AssetOffer offer() const { return {asset_, bytes_.size(), credit_}; }

   private:
    struct Free {
        void operator()(evp_md_ctx_st* context) const;
    };
    std::uint32_t asset_;
    std::string sha256_;
    std::uint64_t size_, credit_;
    std::uint64_t granted_;  // bytes from the start that may have been sent so far
    std::vector<std::byte> bytes_;
    std::unique_ptr<evp_md_ctx_st, Free> hash_;
};

}  // namespace caustream::session
