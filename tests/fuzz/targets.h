// What is fuzzed. Each takes any bytes and ends the process where a promise of the code under test is broken; the same
// functions run under libFuzzer and, over the files of corpus/, in the ordinary tests.
#pragma once
#include <cstdint>
#include <span>

namespace caustream::fuzz {

using Bytes = std::span<const std::uint8_t>;

void clientText(Bytes text);  // decodeClientMessage
void serverText(Bytes text);  // decodeServerMessage
void patches(Bytes text);     // applyPatch: a JSON array of patches, one after the other
void headers(Bytes message);  // decodeFrameHeader and decodeChunkHeader
void glb(Bytes file);         // scene::loadGlb

struct Target {
    const char* name;  // the folder of corpus/, and the program's name behind "fuzz_"
    void (*run)(Bytes);
};
inline constexpr Target kTextTargets[] = {{"client_text", clientText}, {"server_text", serverText}, {"patches", patches}};
inline constexpr Target kBinaryTargets[] = {{"headers", headers}, {"glb", glb}};

// Ends the process with the broken promise on standard error.
void require(bool kept, const char* promise);

}  // namespace caustream::fuzz
