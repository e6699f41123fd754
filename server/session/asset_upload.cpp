#include "session/asset_upload.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <array>
#include <utility>

#include "error.h"
#include "session/random_id.h"

namespace caustream::session {
namespace {

using protocol::DecodeError;
using protocol::ErrorCode;

tl::unexpected<DecodeError> fail(ErrorCode code, std::string message, std::string field) {
    return tl::unexpected(DecodeError{.code = code, .message = std::move(message), .field = std::move(field)});
}

}  // namespace

void AssetUpload::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

AssetUpload::AssetUpload(std::uint32_t asset, const protocol::AssetBegin& begin, const protocol::Limits& limits)
    : asset_(asset),
      sha256_(begin.sha256),
      size_(begin.size),
      credit_(limits.creditBytes),
      granted_(limits.creditBytes),
      hash_(EVP_MD_CTX_new()) {
    if (!hash_ || EVP_DigestInit_ex(hash_.get(), EVP_sha256(), nullptr) != 1) {
        throw Error("SHA-256 is not available; check the installation of libcrypto");
    }
}

AssetUpload::~AssetUpload() = default;

tl::expected<std::optional<protocol::AssetCredit>, DecodeError> AssetUpload::add(const protocol::ChunkHeader& header,
                                                                                 std::span<const std::uint8_t> payload) {
    const std::uint64_t have = bytes_.size();
    if (header.offset != have) {
        return fail(ErrorCode::BadOffset, "the next chunk starts at byte " + std::to_string(have), "offset");
    }
    const std::uint64_t end = have + payload.size();
    if (end > size_ || end > granted_) {
        return fail(ErrorCode::BadOffset,
                    end > size_ ? "the chunk reaches beyond the announced size of " + std::to_string(size_)
                                : "the chunk reaches beyond the credit of " + std::to_string(granted_ - have) + " bytes",
                    "payload_len");
    }
    const uLong sum = crc32_z(crc32_z(0, nullptr, 0), payload.data(), payload.size());
    if (sum != header.crc32) {
        return fail(ErrorCode::AssetInvalid, "the chunk's bytes do not match its checksum; send it again", "crc32");
    }
    const auto bytes = std::as_bytes(payload);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    EVP_DigestUpdate(hash_.get(), payload.data(), payload.size());
    // Half used up: grant the whole again, so that a steady sender never waits.
    if (end < size_ && granted_ - end <= credit_ / 2) {
        granted_ = end + credit_;
        return protocol::AssetCredit{asset_, end, credit_};
    }
    return std::nullopt;
}

tl::expected<std::vector<std::byte>, DecodeError> AssetUpload::finish() {
    if (bytes_.size() != size_) {
        return fail(ErrorCode::AssetInvalid,
                    "the file ends after " + std::to_string(bytes_.size()) + " of " + std::to_string(size_) + " bytes", "size");
    }
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    EVP_DigestFinal_ex(hash_.get(), digest.data(), &length);
    const std::string sha256 = hex({digest.data(), length});
    if (sha256 != sha256_) {
        return fail(ErrorCode::AssetInvalid, "the file's SHA-256 is " + sha256, "sha256");
    }
    return std::move(bytes_);
}

}  // namespace caustream::session
