#include "scene/image_decoder.h"

#include <png.h>
#include <turbojpeg.h>
#include <algorithm>
#include <memory>

namespace caustream::scene {

namespace {

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

bool fits(std::size_t width, std::size_t height, std::size_t maxTexels) {
    return width > 0 && height > 0 && width <= maxTexels / height;
}

tl::expected<Texture, LoadError> decodePng(std::span<const std::uint8_t> bytes, std::size_t maxTexels,
                                           const std::string& what) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const std::unique_ptr<png_image, void (*)(png_image*)> release(&image, png_image_free);
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
        return fail(what + " is not a PNG that can be read: " + image.message);
    if (!fits(image.width, image.height, maxTexels)) return fail(what + " has more texels than are allowed");
    image.format = PNG_FORMAT_RGBA;
    Texture texture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    texture.rgba.resize(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, texture.rgba.data(), 0, nullptr))
        return fail(what + " is a damaged PNG: " + image.message);
    return texture;
}

tl::expected<Texture, LoadError> decodeJpeg(std::span<const std::uint8_t> bytes, std::size_t maxTexels,
                                            const std::string& what) {
    const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
    Texture texture;
    int subsampling = 0, colorspace = 0;
    if (!decoder || tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &texture.width, &texture.height,
                                        &subsampling, &colorspace) != 0)
        return fail(what + " is neither a PNG nor a JPEG");
    if (texture.width < 0 || texture.height < 0 || !fits(texture.width, texture.height, maxTexels))
        return fail(what + " has more texels than are allowed");
    texture.rgba.resize(static_cast<std::size_t>(texture.width) * texture.height * 4);
    if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), texture.rgba.data(), texture.width, 0, texture.height,
                      TJPF_RGBA, TJFLAG_LIMITSCANS) != 0)
        return fail(what + " is a damaged JPEG: " + tjGetErrorStr2(decoder.get()));
    return texture;
}

}  // namespace

tl::expected<Texture, LoadError> decodeImage(std::span<const std::uint8_t> bytes, std::size_t maxTexels,
                                             const std::string& what) {
    constexpr std::size_t kTexelsFree = 1u << 20, kTexelsPerByte = 1024;  // deflate packs 1032 equal bytes into one
    maxTexels = std::min(maxTexels, kTexelsFree + kTexelsPerByte * bytes.size());
    if (bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0) return decodePng(bytes, maxTexels, what);
    return decodeJpeg(bytes, maxTexels, what);
}

}  // namespace caustream::scene
