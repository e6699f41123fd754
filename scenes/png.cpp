#include "scenes/png.h"

#include <png.h>
#include <stdexcept>
#include <string>

namespace caustream::scenes {

std::vector<std::uint8_t> encodePng(int width, int height, const std::vector<std::uint8_t>& rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> png(PNG_IMAGE_PNG_SIZE_MAX(image));
    png_alloc_size_t size = png.size();
    if (!png_image_write_to_memory(&image, png.data(), &size, 0, rgb.data(), 0, nullptr))
        throw std::runtime_error(std::string("cannot write a texture: ") + image.message);
    png.resize(size);
    return png;
}

}  // namespace caustream::scenes
