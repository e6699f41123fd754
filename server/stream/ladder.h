// The quality ladder: what a stream gives up, level by level, for frames that are smaller. Quality and colour first, then
// size: a caustic's thin colours go before its lines do. The rate controller picks the level, the encoder obeys.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace caustream::stream {

// Of a JPEG's two colour planes: as large as the picture (4:4:4), or half as wide and as high (4:2:0).
enum class Subsampling { None, Half };

struct LadderLevel {
    double scale = 1.0;                    // of the picture's sides to those of the view
    int jpegQuality = 90;                  // 1..100; below 90 and 4:4:4 a dispersed caustic's thin colours wash out
    Subsampling subsampling = Subsampling::None;
    double testBytes = 1.0;                // what of a test frame's bytes the level leaves (protocol's flag TEST)
};

class Ladder {
   public:
    struct Size {
        int width = 0, height = 0;         // pixels
        bool operator==(const Size&) const = default;
    };

    static constexpr std::array<LadderLevel, 6> kLevels = {{{1.0, 90, Subsampling::None, 1.0},
                                                            {1.0, 80, Subsampling::None, 0.72},
                                                            {1.0, 80, Subsampling::Half, 0.6},
                                                            {1.0, 60, Subsampling::Half, 0.42},
                                                            {0.75, 60, Subsampling::Half, 0.26},
                                                            {0.5, 60, Subsampling::Half, 0.14}}};
    static constexpr int kBest = 0, kWorst = static_cast<int>(kLevels.size()) - 1;
    static constexpr int kFixed = 255;     // a frame header's level where the ladder is not used

    // `level` is kBest..kWorst; beyond either end it is that end.
    static constexpr const LadderLevel& at(int level) {
        return kLevels[static_cast<std::size_t>(std::clamp(level, kBest, kWorst))];
    }

    // The picture's size at a level of a view of `full`. No side gets shorter than the protocol's shortest, 16 pixels; sides
    // are rounded, so that the picture's shape is the view's to half a pixel.
    static Size scaled(Size full, int level) {
        const auto side = [&](int pixels) { return std::max(std::min(pixels, 16), static_cast<int>(std::lround(at(level).scale * pixels))); };
        return {side(full.width), side(full.height)};
    }
};

}  // namespace caustream::stream
