// Gzipped NumPy arrays of little-endian float32.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace caustream::reference {

struct Array {
    std::vector<std::size_t> shape;
    std::vector<float> values;  // C order
};

// Throws std::runtime_error that names the file.
Array readNpyGz(const std::string& path);

}  // namespace caustream::reference
