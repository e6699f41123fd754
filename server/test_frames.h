// Frames of noise instead of pictures, of a given size and cost: what measures a link, a window or a scheduler must not
// wait for a renderer. They carry the flag TEST. Render thread only.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scheduler.h"
#include "stream/encode_pool.h"

namespace caustream {

class TestFrames {
   public:
    // `bytes` of payload at the ladder's best level, `ms` of sleep a frame.
    TestFrames(std::size_t bytes, int ms);

    bool wanted() const { return !noise_.empty(); }

    // A frame of the job's size with no pixels, and in `encoded` its payload behind room for the header.
    render::Frame draw(const FrameJob& job, stream::Encoded& encoded) const;

   private:
    std::vector<std::uint8_t> noise_;
    int ms_;
};

}  // namespace caustream
