#include <cstring>

#include "mutators.h"
#include "tests/unit/glb_editor.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace caustream::fuzz {
namespace {

using Data = std::vector<std::uint8_t>;

Data mutateBytes(Data bytes, std::size_t maxSize) {
    const std::size_t size = std::min(bytes.size(), maxSize);
    bytes.resize(maxSize);
    bytes.resize(LLVMFuzzerMutate(bytes.data(), size, maxSize));
    return bytes;
}

struct Chunks {
    std::string json;
    Data binary;
};

// False where the lengths do not lead through the file.
bool split(const Data& file, Chunks& chunks) {
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    std::size_t at = kHeader;
    for (int chunk = 0; chunk < 2 && at + kChunkHeader <= file.size(); ++chunk) {
        std::uint32_t size = 0;
        std::memcpy(&size, file.data() + at, 4);
        at += kChunkHeader;
        if (size > file.size() - at) {
            return false;
        }
        const auto* begin = file.data() + at;
        chunk == 0 ? void(chunks.json.assign(begin, begin + size)) : chunks.binary.assign(begin, begin + size);
        at += size;
    }
    return !chunks.json.empty();
}

}  // namespace

std::vector<std::uint8_t> mutateGlb(std::vector<std::uint8_t> file, std::size_t maxSize, std::mt19937& dice) {
    constexpr std::size_t kAround = 64;  // headers and padding
    Chunks chunks;
    if (dice() % 20 == 0 || maxSize < kAround || !split(file, chunks)) {
        return mutateBytes(std::move(file), maxSize);
    }
    const std::size_t room = maxSize - kAround;
    const unsigned which = dice() % 5;
    if (which < 3 && chunks.binary.size() < room) {
        chunks.json = mutateJson(chunks.json, room - chunks.binary.size(), dice);
    }
    if (which > 1 && chunks.json.size() < room) {
        chunks.binary = mutateBytes(std::move(chunks.binary), room - chunks.json.size());
    }
    return test::packText(std::move(chunks.json), chunks.binary);
}

}  // namespace caustream::fuzz
