// Damaged messages and files, the same ones on every run: from every valid message of a client, chunk headers, and a GLB.
#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace caustream::bench {

// Engine output is fixed by the standard; distributions are not.
class Dice {
   public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    std::size_t below(std::size_t bound) { return engine_() % bound; }

 private:
    std::mt19937 engine_;
};

std::string damagedText(std::string text, Dice& dice);     // one to three places of a JSON message
std::string damagedValues(const std::string& text, Dice& dice);   // JSON as before, one or two values strange
std::string damagedBytes(std::string bytes, Dice& dice);   // bits, lengths, truncation, repetition
std::string damagedGlb(const std::string& glb, Dice& dice);   // its header, its JSON or its geometry, lengths often put right again

// The valid messages of a client, as text, as the vectors and the tests have them.
const std::vector<std::string>& validMessages();

// A CHUNK for `asset` with a right checksum.
std::string validChunk(std::uint32_t asset, std::uint64_t offset, const std::string& payload);

}  // namespace caustream::bench
