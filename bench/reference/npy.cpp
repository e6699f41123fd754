#include "bench/reference/npy.h"

#include <zlib.h>
#include <array>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace caustream::npy {

namespace {

// gzread() passes what is not gzipped as it is.
std::string readGz(const std::string& path) {
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
    if (!file) throw std::runtime_error("cannot open " + path);
    std::string bytes, block(1 << 16, '\0');
    int got = 0;
    while ((got = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()))) > 0)
        bytes.append(block, 0, static_cast<std::size_t>(got));
    if (got < 0) throw std::runtime_error("cannot unpack " + path);
    return bytes;
}

}  // namespace

// NumPy, format.py, version 1.0: magic, version, u16 header length, a Python dictionary as text, then the data.
Array read(const std::string& path) {
    const std::string bytes = readGz(path);
    constexpr std::size_t kPrefix = 10;
    if (bytes.size() < kPrefix || bytes.compare(0, 7, "\x93NUMPY\x01") != 0)
        throw std::runtime_error(path + " is not a NumPy 1.0 array");
    const std::size_t headerSize = static_cast<unsigned char>(bytes[8]) | static_cast<unsigned char>(bytes[9]) << 8;
    const std::string header = bytes.substr(kPrefix, headerSize);
    if (header.find("'<f4'") == std::string::npos || header.find("False") == std::string::npos)
        throw std::runtime_error(path + " is not float32 in C order");

    Array array;
    const std::size_t open = header.find('('), close = header.find(')');
    if (open == std::string::npos || close == std::string::npos) throw std::runtime_error(path + " has no shape");
    std::istringstream shape(header.substr(open + 1, close - open - 1));
    std::size_t total = 1;
    for (std::string number; std::getline(shape, number, ',');) {
        if (number.find_first_of("0123456789") == std::string::npos) continue;
        array.shape.push_back(std::stoul(number));
        total *= array.shape.back();
    }
    if (bytes.size() != kPrefix + headerSize + total * sizeof(float))
        throw std::runtime_error(path + " does not hold what its shape says");
    array.values.resize(total);
    std::memcpy(array.values.data(), bytes.data() + kPrefix + headerSize, total * sizeof(float));
    return array;
}

void write(const std::string& path, const std::vector<std::size_t>& shape, const std::vector<float>& values) {
    std::string tuple;
    for (const std::size_t length : shape) tuple.append(std::to_string(length)).append(", ");
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + tuple + "), }";
    // The data begin at a multiple of 64 bytes, after a line end.
    constexpr std::size_t kPrefix = 10, kAlign = 64;
    header.resize((kPrefix + header.size() + 1 + kAlign - 1) / kAlign * kAlign - kPrefix - 1, ' ');
    header += '\n';
    const bool pack = path.ends_with(".gz");
    const gzFile file = gzopen(path.c_str(), pack ? "wb9" : "wbT");
    if (!file) throw std::runtime_error("cannot write " + path);
    const std::array<char, kPrefix> prefix{'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
    gzwrite(file, prefix.data(), static_cast<unsigned>(prefix.size()));
    gzwrite(file, header.data(), static_cast<unsigned>(header.size()));
    gzwrite(file, values.data(), static_cast<unsigned>(values.size() * sizeof(float)));
    if (gzclose(file) != Z_OK) throw std::runtime_error("cannot write " + path);
}

}  // namespace caustream::npy
