// PNG or JPEG bytes -> Texture, by libpng and libjpeg-turbo: both decode row by row, so a small file cannot ask for
// more memory than its announced size, which is checked first.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "scene/gltf_loader.h"

namespace caustream::scene {

// At most `maxTexels`, and 1024 for each byte of the file above the first million: no more than any picture that is not
// made to swell. Errors name `what`.
tl::expected<Texture, LoadError> decodeImage(std::span<const std::uint8_t> bytes, std::size_t maxTexels,
                                             const std::string& what);

}  // namespace caustream::scene
