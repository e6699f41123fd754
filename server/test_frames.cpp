#include "test_frames.h"

#include <chrono>
#include <cstring>
#include <random>
#include <thread>

namespace caustream {

TestFrames::TestFrames(std::size_t bytes, int ms) : noise_(bytes), ms_(ms) {
    std::mt19937_64 random(1);  // nothing on the way may make it smaller
    for (std::uint8_t& byte : noise_) {
        byte = static_cast<std::uint8_t>(random());
    }
}

render::Frame TestFrames::draw(const FrameJob& job, stream::Encoded& encoded) const {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms_));
    const render::Request& request = job.shown.view->request;
    const bool ladder = job.level != stream::Ladder::kFixed;
    const auto size = stream::Ladder::scaled({request.width, request.height}, ladder ? job.level : stream::Ladder::kBest);
    render::Frame frame;
    frame.width = size.width;
    frame.height = size.height;
    frame.stats.renderMs = ms_;
    const double share = ladder ? stream::Ladder::at(job.level).testBytes : 1.0;
    const auto bytes = static_cast<std::size_t>(share * static_cast<double>(noise_.size()));
    encoded.buffer = stream::WireBuffer(protocol::kFrameHeaderBytes + bytes);
    std::memcpy(encoded.buffer.data() + protocol::kFrameHeaderBytes, noise_.data(), bytes);
    return frame;
}

}  // namespace caustream
