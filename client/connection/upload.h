// One asset on its way to the server: in chunks, no more at once than the server's credit. Called on the socket's
// thread.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/messages.h"

namespace caustream::connection {

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

// 64 lower-case hex digits.
std::string sha256Hex(std::span<const std::uint8_t> bytes);

class Upload {
 public:
    struct Wire {
        std::function<std::uint32_t()> nextId;
        std::function<void(std::string)> text;
        std::function<void(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload)> binary;
    };

    Upload(Bytes bytes, Wire wire);

    const Bytes& bytes() const { return bytes_; }
    const std::string& sha256() const { return sha256_; }
    std::uint64_t size() const { return bytes_->size(); }
    std::uint64_t confirmed() const { return confirmed_; }  // bytes that the server says it has
    bool done() const { return done_; }
    bool failed() const { return failed_; }

    // From the start, or from where the server says it got to before the connection broke.
    void begin(const protocol::Limits& limits);
    // True when the message was about this upload.
    bool take(const protocol::Ok& ok);
    bool take(const protocol::ErrorMessage& error);
    void take(const protocol::AssetCredit& credit);

 private:
    void pump();

    Bytes bytes_;
    Wire wire_;
    std::string sha256_;
    protocol::Limits limits_;
    std::uint32_t beginId_ = 0, endId_ = 0, asset_ = 0;
    std::uint64_t sent_ = 0, mayReach_ = 0, confirmed_ = 0;
    bool done_ = false, failed_ = false;
};

}  // namespace caustream::connection
