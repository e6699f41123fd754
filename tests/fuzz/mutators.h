// Changes that get past the first checks, where random bytes seldom do. Built on libFuzzer's own.
#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace caustream::fuzz {

// Mostly a value exchanged, repeated, left out or bent somewhere in the tree; sometimes bytes.
std::string mutateJson(const std::string& text, std::size_t maxSize, std::mt19937& dice);

// The JSON or the binary chunk of a GLB, with the lengths of header and chunks put right; sometimes bytes.
std::vector<std::uint8_t> mutateGlb(std::vector<std::uint8_t> file, std::size_t maxSize, std::mt19937& dice);

}  // namespace caustream::fuzz
