#include "tests/reference/npy.h"

#include <zlib.h>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace caustream::reference {

namespace {

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
Array readNpyGz(const std::string& path) {
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

}  // namespace caustream::reference
