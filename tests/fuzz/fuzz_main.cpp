// One libFuzzer program for each target: CAUSTREAM_FUZZ_TARGET is its function, CAUSTREAM_FUZZ_MUTATOR 0 (libFuzzer's), 1
// (JSON) or 2 (GLB).
#include <algorithm>

#include "mutators.h"
#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    caustream::fuzz::CAUSTREAM_FUZZ_TARGET({data, size});
    return 0;
}

#if CAUSTREAM_FUZZ_MUTATOR > 0
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize, unsigned seed) {
    std::mt19937 dice(seed);
#if CAUSTREAM_FUZZ_MUTATOR == 1
    const auto changed = caustream::fuzz::mutateJson(std::string(data, data + size), maxSize, dice);
#else
    const auto changed = caustream::fuzz::mutateGlb({data, data + size}, maxSize, dice);
#endif
    const std::size_t kept = std::min(changed.size(), maxSize);
    std::copy_n(changed.begin(), kept, data);
    return kept;
}
#endif
