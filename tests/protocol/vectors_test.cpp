// The vectors of protocol/vectors, which are made from the specification and not from this code, through our decoders.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "protocol/frame_header.h"
#include "protocol/messages.h"
#include "protocol/patch.h"

namespace caustream::protocol {
namespace {

Json vectorsOf(const std::string& file) {
    std::ifstream in(std::string(CAUSTREAM_VECTORS) + "/" + file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const Json all = Json::parse(text, nullptr, false);
    EXPECT_TRUE(all.is_object() && all.contains("vectors")) << file;
    return all.value("vectors", Json::array());
}

std::vector<std::uint8_t> bytesOf(const Json& hex) {
    const std::string text = hex;
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
    return bytes;
}

std::string textOf(const Json& vector) {
    if (vector.contains("text")) return vector["text"];
    const auto bytes = bytesOf(vector["hex"]);
    return {bytes.begin(), bytes.end()};
}

void expectError(const Json& vector, const DecodeError& error) {
    EXPECT_EQ(errorName(error.code), vector["error"]["code"].get<std::string>()) << error.message;
    EXPECT_EQ(error.field, vector["error"]["field"].get<std::string>()) << error.message;
    EXPECT_FALSE(error.message.empty());
}

// A field says `value` if the message, said again, has it; or if saying it changes nothing: it is the default then.
template <class Decode>
void expectFields(const Json& vector, const Decode& decode) {
    const auto message = decode(textOf(vector), vector.value("strict", false));
    ASSERT_TRUE(message.has_value()) << message.error().message << " " << message.error().field;
    const std::string again = encode(*message);
    EXPECT_EQ(decode(again, false), message) << again;
    const Json said = Json::parse(again);
    for (const auto& [name, value] : vector["fields"].items()) {
        if (said.contains(name)) {
            EXPECT_EQ(said[name], value) << name;
        } else {
            Json explicitly = Json::parse(textOf(vector));
            explicitly[name] = value;
            EXPECT_EQ(decode(explicitly.dump(), false), message) << name;
        }
    }
}

template <class Decode>
void runTexts(const std::string& file, const Decode& decode) {
    const Json vectors = vectorsOf(file);
    EXPECT_GE(vectors.size(), 40u);
    for (const Json& vector : vectors) {
        SCOPED_TRACE(vector["name"].get<std::string>());
        if (vector.contains("fields")) {
            expectFields(vector, decode);
        } else {
            const auto message = decode(textOf(vector), vector.value("strict", false));
            EXPECT_FALSE(message.has_value());
            if (!message) expectError(vector, message.error());
        }
    }
}

TEST(Vectors, ClientMessages) {
    runTexts("client_messages.json", [](const std::string& text, bool strict) { return decodeClientMessage(text, {}, strict); });
}

TEST(Vectors, ServerMessages) {
    runTexts("server_messages.json", [](const std::string& text, bool strict) { return decodeServerMessage(text, {}, strict); });
}

std::map<std::string, double> fieldsOf(const FrameHeader& h) {
    return {{"header_len", h.headerLen}, {"frame_seq", h.frameSeq}, {"stream", h.stream}, {"epoch", h.epoch},
            {"target", static_cast<double>(h.target)}, {"encoding", static_cast<double>(h.encoding)},
            {"sample", static_cast<double>(h.sample)}, {"layout", static_cast<double>(h.layout)}, {"flags", h.flags},
            {"width", h.width}, {"height", h.height}, {"view_width", h.viewWidth}, {"view_height", h.viewHeight}, {"bands", h.bands},
            {"jpeg_quality", h.jpegQuality}, {"level", h.level}, {"input_seq", h.inputSeq}, {"state_rev", h.stateRev},
            {"client_us", static_cast<double>(h.clientUs)}, {"server_us", static_cast<double>(h.serverUs)}, {"hold_us", h.holdUs},
            {"render_us", h.renderUs}, {"encode_us", h.encodeUs}, {"payload_len", h.payloadLen}, {"raw_len", h.rawLen},
            {"scale", static_cast<double>(h.scale)}};
}

std::map<std::string, double> fieldsOf(const ChunkHeader& h) {
    return {{"header_len", h.headerLen}, {"asset", h.asset}, {"offset", static_cast<double>(h.offset)},
            {"payload_len", h.payloadLen}, {"crc32", h.crc32}};
}

template <class Header>
void runHeader(const Json& vector, const tl::expected<Header, DecodeError>& header) {
    if (vector.contains("error")) {
        EXPECT_FALSE(header.has_value());
        if (!header) expectError(vector, header.error());
        return;
    }
    ASSERT_TRUE(header.has_value()) << header.error().message;
    const auto fields = fieldsOf(*header);
    EXPECT_EQ(fields.size(), vector["fields"].size());
    for (const auto& [name, value] : fields) EXPECT_EQ(value, vector["fields"].value(name, std::nan(""))) << name;
    // The header as we write it is the vector's own, up to what longer headers add.
    const auto bytes = bytesOf(vector["hex"]), payload = bytesOf(vector["payload"]);
    Header written = *header;
    const auto again = encodeHeader(written);
    for (std::size_t i = 4; i < again.size(); ++i) EXPECT_EQ(again[i], bytes[i]) << "byte " << i;
    EXPECT_TRUE(std::equal(payload.begin(), payload.end(), bytes.begin() + header->headerLen));
}

TEST(Vectors, BinaryHeaders) {
    const Json vectors = vectorsOf("binary_headers.json");
    EXPECT_GE(vectors.size(), 40u);
    for (const Json& vector : vectors) {
        SCOPED_TRACE(vector["name"].get<std::string>());
        const auto bytes = bytesOf(vector["hex"]);
        if (vector["kind"] == "frame") runHeader(vector, decodeFrameHeader(bytes));
        else runHeader(vector, decodeChunkHeader(bytes));
    }
}

TEST(Vectors, Patches) {
    const Json vectors = vectorsOf("patches.json");
    EXPECT_GE(vectors.size(), 40u);
    for (const Json& vector : vectors) {
        SCOPED_TRACE(vector["name"].get<std::string>());
        const auto applied = applyPatch(vector["document"], vector["patch"], {}, vector.value("strict", false));
        if (vector.contains("error")) {
            EXPECT_FALSE(applied.has_value());
            if (!applied) expectError(vector, applied.error());
            continue;
        }
        ASSERT_TRUE(applied.has_value()) << applied.error().message << " " << applied.error().field;
        // `after` is all that is said, so that defaults aside the documents decode to the same state.
        const auto after = applyPatch(Json::object(), vector["after"]);
        ASSERT_TRUE(after.has_value()) << after.error().message;
        EXPECT_EQ(applied->document, after->document);
        EXPECT_EQ(applied->state, after->state);
        const Json flat = vector["after"].flatten(), had = applied->document.flatten();
        for (const auto& [pointer, value] : flat.items()) {
            if (!value.is_null() && !value.empty()) {
                EXPECT_EQ(had.value(pointer, Json()), value) << pointer;
            }
        }
    }
}

}  // namespace
}  // namespace caustream::protocol
