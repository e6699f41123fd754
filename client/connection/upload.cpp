#include "client/connection/upload.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <array>

namespace caustream::connection {

std::string sha256Hex(std::span<const std::uint8_t> bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
    std::string hex;
    for (unsigned int i = 0; i < length; ++i) {
        constexpr char kDigits[] = "0123456789abcdef";
        hex += kDigits[digest[i] >> 4];
        hex += kDigits[digest[i] & 15];
    }
    return hex;
}

Upload::Upload(Bytes bytes, Wire wire)
    : bytes_(std::move(bytes)), wire_(std::move(wire)), sha256_(sha256Hex(*bytes_)) {}

void Upload::begin(const protocol::Limits& limits) {
    limits_ = limits;
    asset_ = endId_ = 0;
    sent_ = mayReach_ = confirmed_ = 0;
    done_ = failed_ = false;
    beginId_ = wire_.nextId();
    wire_.text(protocol::encode(protocol::AssetBegin{.id = beginId_, .sha256 = sha256_, .size = bytes_->size()}));
}

bool Upload::take(const protocol::Ok& ok) {
    if (ok.id == beginId_ && ok.offer) {
        asset_ = ok.offer->asset;
        sent_ = confirmed_ = std::min<std::uint64_t>(ok.offer->have, size());
        mayReach_ = ok.offer->have + ok.offer->credit;
        pump();
        return true;
    }
    if (endId_ != 0 && ok.id == endId_) {
        confirmed_ = size();
        done_ = true;
        return true;
    }
    return false;
}

bool Upload::take(const protocol::ErrorMessage& error) {
    if (!error.id || (*error.id != beginId_ && *error.id != endId_)) return false;
    failed_ = true;
    return true;
}

void Upload::take(const protocol::AssetCredit& credit) {
    if (asset_ == 0 || credit.asset != asset_) return;
    confirmed_ = std::min<std::uint64_t>(credit.have, size());
    mayReach_ = std::max(mayReach_, credit.have + credit.credit);
    pump();
}

void Upload::pump() {
    while (sent_ < size() && sent_ < mayReach_) {
        const auto length = std::min<std::uint64_t>({limits_.chunkBytes, size() - sent_, mayReach_ - sent_});
        const std::span payload(bytes_->data() + sent_, length);
        const auto head = protocol::encodeHeader(protocol::ChunkHeader{
            .asset = asset_,
            .offset = sent_,
            .payloadLen = static_cast<std::uint32_t>(length),
            .crc32 = static_cast<std::uint32_t>(::crc32(0, payload.data(), static_cast<uInt>(length))),
        });
        wire_.binary(head, payload);
        sent_ += length;
    }
    if (sent_ == size() && endId_ == 0) {
        endId_ = wire_.nextId();
        wire_.text(protocol::encode(protocol::AssetEnd{.id = endId_, .asset = asset_}));
    }
}

}  // namespace caustream::connection
