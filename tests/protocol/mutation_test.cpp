// Both decoders on thousands of damaged messages, the same ones on every run: each comes back as a value, an error is
// complete, and what is accepted can be said again.
#include <gtest/gtest.h>

#include <iterator>
#include <random>

#include "protocol/patch.h"
#include "samples.h"

namespace caustream::protocol {
namespace {

constexpr int kRounds = 150;  // for each sample

// Engine output is fixed by the standard; distributions are not.
class Dice {
 public:
    std::size_t below(std::size_t bound) { return engine_() % bound; }

 private:
    std::mt19937 engine_{20260101};
};

// Bits of text that decoders trip over.
const std::string kSplinters[] = {"null",       "-1",      "1e999",
                                  "1.5",        "[]",      "{}",
                                  "\"\"",       "true",    "NaN",
                                  "4294967296", "0",       "[[[[",
                                  "}}}}",       "\\u0",    "\"",
                                  "\xff",       ",",       ":",
                                  "1e308",      "-0.0",    "18446744073709551616",
                                  "\"op\":",    "\"id\":", std::string("\0", 1)};

std::string damaged(std::string text, Dice& dice) {
    for (std::size_t hits = 1 + dice.below(3); hits > 0; --hits) {
        const std::size_t at = dice.below(text.size() + 1), length = dice.below(12);
        const std::string& splinter = kSplinters[dice.below(std::size(kSplinters))];
        switch (dice.below(5)) {
            case 0:
                if (at < text.size()) text[at] = char(text[at] ^ (1 << dice.below(8)));
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, splinter);
                break;
            case 3:
                text.replace(at, length, splinter);
                break;
            default:
                text.insert(at, text.substr(dice.below(text.size() + 1), length));
                break;
        }
    }
    return text;
}

void expectComplete(const DecodeError& error) {
    EXPECT_FALSE(errorName(error.code).empty());
    EXPECT_FALSE(error.message.empty());
}

TEST(Mutation, ClientMessages) {
    Dice dice;
    for (const auto& sample : clientSamples())
        for (int round = 0; round < kRounds; ++round) {
            const std::string text = damaged(sample.text, dice);
            const auto message = decodeClientMessage(text, {}, round % 2 == 0);
            if (!message)
                expectComplete(message.error());
            else
                EXPECT_EQ(decodeClientMessage(encode(*message)), message) << text;
        }
}

TEST(Mutation, ServerMessages) {
    Dice dice;
    for (const auto& sample : serverSamples())
        for (int round = 0; round < kRounds; ++round) {
            const std::string text = damaged(sample.text, dice);
            const auto message = decodeServerMessage(text, {}, round % 2 == 0);
            if (!message)
                expectComplete(message.error());
            else
                EXPECT_EQ(decodeServerMessage(encode(*message)), message) << text;
        }
}

// A document whose leaves have been swapped for something else, as a patch.
TEST(Mutation, StateDocuments) {
    Dice dice;
    const Json whole = toJson(fullState());
    const Json flat = whole.flatten();
    const Json strange[] = {nullptr, -1,   1.5,           1e300,          4294967296, "",
                            "x",     true, Json::array(), Json::object(), {1, 2, 3},  {"E"}};
    for (int round = 0; round < 3000; ++round) {
        Json document = whole;
        for (std::size_t hits = 1 + dice.below(3); hits > 0; --hits) {
            Json::json_pointer pointer(std::next(flat.begin(), std::ptrdiff_t(dice.below(flat.size()))).key());
            for (std::size_t up = dice.below(3); up > 0; --up) pointer = pointer.parent_pointer();
            if (document.contains(pointer)) document[pointer] = strange[dice.below(std::size(strange))];
        }
        const auto applied = applyPatch(Json::object(), document, {}, round % 2 == 0);
        if (!applied)
            expectComplete(applied.error());
        else
            EXPECT_EQ(decodeState(applied->document, {}, true), applied->state) << document;
    }
}

TEST(Mutation, BinaryHeaders) {
    Dice dice;
    FrameHeader frame;
    frame.width = frame.height = frame.viewWidth = frame.viewHeight = 4;
    frame.encoding = Encoding::Raw;
    frame.payloadLen = frame.rawLen = 48;
    ChunkHeader chunk;
    chunk.payloadLen = 48;
    const auto frameStart = encodeHeader(frame);
    const auto chunkStart = encodeHeader(chunk);
    for (int round = 0; round < 5000; ++round) {
        std::vector<std::uint8_t> bytes;
        if (round % 2 == 0)
            bytes.assign(frameStart.begin(), frameStart.end());
        else
            bytes.assign(chunkStart.begin(), chunkStart.end());
        bytes.resize(bytes.size() + 48);
        for (std::size_t hits = dice.below(4); hits > 0; --hits)
            bytes[dice.below(100) % bytes.size()] = std::uint8_t(dice.below(256));
        if (dice.below(4) == 0) bytes.resize(dice.below(bytes.size()));
        const auto asFrame = decodeFrameHeader(bytes);
        const auto asChunk = decodeChunkHeader(bytes);
        EXPECT_FALSE(asFrame.has_value() && asChunk.has_value());
        if (asFrame)
            EXPECT_EQ(asFrame->headerLen + std::size_t(asFrame->payloadLen), bytes.size());
        else
            expectComplete(asFrame.error());
        if (asChunk)
            EXPECT_EQ(asChunk->headerLen + std::size_t(asChunk->payloadLen), bytes.size());
        else
            expectComplete(asChunk.error());
    }
}

}  // namespace
}  // namespace caustream::protocol
