// Pictures to files. Every failure is a sentence that names the file.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "client/connection/image.h"

namespace caustream::connection {

using Written = tl::expected<void, std::string>;

// `picture` has U8 samples and 1 or 3 bands.
Written writePng(const std::filesystem::path& file, const Image& picture);
Written writeJpeg(const std::filesystem::path& file, const Image& picture, int quality);

// NumPy's format, version 1.0: little-endian float32 of shape (height, width, bands).
Written writeNpy(const std::filesystem::path& file, const Image& image);

Written writeBytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace caustream::connection
