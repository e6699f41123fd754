// NumPy arrays of little-endian float32.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace caustream::npy {

struct Array {
    std::vector<std::size_t> shape;
    std::vector<float> values;  // C order
};

// A file as it is, or gzipped. Throws std::runtime_error that names it.
Array read(const std::string& path);

// Gzipped where the name ends in .gz. `values` must be as many as `shape` says. Throws std::runtime_error that names the file.
void write(const std::string& path, const std::vector<std::size_t>& shape, const std::vector<float>& values);

}  // namespace caustream::npy
