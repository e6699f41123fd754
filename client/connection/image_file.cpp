#include "client/connection/image_file.h"

#include <png.h>
#include <turbojpeg.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace caustream::connection {
namespace {

static_assert(std::endian::native == std::endian::little, "NPY files are written as they lie in memory");

tl::unexpected<std::string> failed(const std::filesystem::path& file, const std::string& why) {
    return tl::make_unexpected("cannot write " + file.string() + ": " + why);
}

}  // namespace

Written writeBytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
    std::FILE* out = std::fopen(file.c_str(), "wb");
    if (!out)
        return failed(file, std::string(std::strerror(errno)) + "; does its folder exist and may you write there?");
    bool good = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
    const int error = errno;
    good = std::fclose(out) == 0 && good;
    if (!good) return failed(file, std::string(std::strerror(error)) + "; is the disk full?");
    return {};
}

Written writePng(const std::filesystem::path& file, const Image& picture) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(picture.width);
    png.height = static_cast<png_uint_32>(picture.height);
    png.format = picture.bands == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::uint8_t> bytes(size);
    if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, picture.data.data(), 0, nullptr))
        return failed(file, png.message);
    return writeBytes(file, {bytes.data(), size});
}

Written writeJpeg(const std::filesystem::path& file, const Image& picture, int quality) {
    const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
    if (!encoder) return failed(file, "no JPEG encoder");
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const bool grey = picture.bands == 1;
    const int result =
        tjCompress2(encoder.get(), picture.data.data(), picture.width, 0, picture.height, grey ? TJPF_GRAY : TJPF_RGB,
                    &bytes, &size, grey ? TJSAMP_GRAY : TJSAMP_444, quality, 0);
    const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
    if (result != 0) return failed(file, tjGetErrorStr2(encoder.get()));
    return writeBytes(file, {bytes, size});
}

Written writeNpy(const std::filesystem::path& file, const Image& image) {
    std::string head = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(image.height) + ", " +
                       std::to_string(image.width) + ", " + std::to_string(image.bands) + "), }";
    // The data starts at a multiple of 64, behind ten bytes of magic, version and length, and a line feed ends the
    // header.
    head.append(63 - (10 + head.size()) % 64, ' ');
    head += '\n';
    const std::vector<float> values = toFloats(image);

    std::vector<std::uint8_t> bytes(10 + head.size() + 4 * values.size());
    std::memcpy(bytes.data(), "\x93NUMPY\x01\x00", 8);
    bytes[8] = static_cast<std::uint8_t>(head.size() & 0xff);
    bytes[9] = static_cast<std::uint8_t>(head.size() >> 8);
    std::memcpy(bytes.data() + 10, head.data(), head.size());
    std::memcpy(bytes.data() + 10 + head.size(), values.data(), 4 * values.size());
    return writeBytes(file, bytes);
}

}  // namespace caustream::connection
