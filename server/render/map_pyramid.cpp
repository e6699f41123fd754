#include "render/map_pyramid.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace caustream::render {

std::size_t pyramidTexels(int size, int levels) {
    std::size_t texels = 0;
    for (int level = 0; level < levels; ++level) texels += static_cast<std::size_t>(size >> level) * static_cast<std::size_t>(size >> level);
    return texels;
}

template <class T>
std::vector<float> sumPyramid(const std::vector<T>& map, int size, int levels, int bands) {
    std::vector<float> above, own;
    for (int level = levels - 1; level >= 0; --level) {
        const int side = size >> level, coarse = side / 2;
        const std::size_t first = pyramidTexels(size, level) * static_cast<std::size_t>(bands);
        own.assign(map.begin() + static_cast<std::ptrdiff_t>(first),
                   map.begin() + static_cast<std::ptrdiff_t>(first + pyramidTexels(side, 1) * static_cast<std::size_t>(bands)));
        for (int y = 0; y < side && !above.empty(); ++y) {
            for (int x = 0; x < side; ++x) {
                // A fine texel's middle lies a quarter from its coarse texel's, towards the neighbour it shares with.
                const int x0 = x / 2, y0 = y / 2;
                const int x1 = std::clamp(x0 + (x % 2 ? 1 : -1), 0, coarse - 1), y1 = std::clamp(y0 + (y % 2 ? 1 : -1), 0, coarse - 1);
                float* to = &own[static_cast<std::size_t>(y * side + x) * static_cast<std::size_t>(bands)];
                const auto from = [&](int cx, int cy) { return &above[static_cast<std::size_t>(cy * coarse + cx) * static_cast<std::size_t>(bands)]; };
                const float *a = from(x0, y0), *b = from(x1, y0), *c = from(x0, y1), *d = from(x1, y1);
                for (int k = 0; k < bands; ++k) to[k] += (9.0f * a[k] + 3.0f * b[k] + 3.0f * c[k] + d[k]) / 64.0f;
            }
        }
        above.swap(own);
    }
    return above;
}

template std::vector<float> sumPyramid(const std::vector<std::uint32_t>&, int, int, int);
template std::vector<float> sumPyramid(const std::vector<float>&, int, int, int);

std::vector<float> adaptPyramid(std::vector<float> finest, std::vector<std::uint32_t> landings, int size, int levels, int bands, double enough) {
    const auto wide = static_cast<std::size_t>(bands);
    std::vector<float> kept;
    kept.reserve(pyramidTexels(size, levels) * wide);
    for (int level = 0; level + 1 < levels; ++level) {
        const int side = size >> level, coarse = side / 2;
        std::vector<float> rest(pyramidTexels(coarse, 1) * wide);
        std::vector<std::uint32_t> above(pyramidTexels(coarse, 1));
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) above[static_cast<std::size_t>(y / 2 * coarse + x / 2)] += landings[static_cast<std::size_t>(y * side + x)];
        }
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const auto parent = static_cast<std::size_t>(y / 2 * coarse + x / 2);
                const auto t = static_cast<float>(std::clamp((above[parent] / enough - 0.25) / 0.75, 0.0, 1.0));
                const float stays = t * t * (3.0f - 2.0f * t);
                float* from = &finest[static_cast<std::size_t>(y * side + x) * wide];
                for (std::size_t k = 0; k < wide; ++k) {
                    rest[parent * wide + k] += (1.0f - stays) * from[k];
                    from[k] *= stays;
                }
            }
        }
        kept.insert(kept.end(), finest.begin(), finest.end());
        finest.swap(rest);
        landings.swap(above);
    }
    kept.insert(kept.end(), finest.begin(), finest.end());
    return kept;
}

}  // namespace caustream::render
