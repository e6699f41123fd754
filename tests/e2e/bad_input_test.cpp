// Whatever comes, the answer names the field, nothing is applied, the connection goes on and so do the other viewers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raw_client.h"
#include "server_process.h"

namespace caustream::e2e {
namespace {

using testing::HasSubstr;

const Json kSmall = {{"transport", {{"photon_grid", 64}, {"map_size", 64}}}, {"stream", {{"width", 64}, {"height", 64}}}};

struct BadText {
    std::string text, code, field;
};

// Patches that must be refused whole, and the field that the answer names.
struct BadPatch {
    std::string patch, code, field;
};

std::string updateText(const std::string& patch) { return R"({"op":"update","id":77,"patch":)" + patch + "}"; }

class BadInput : public testing::Test {
   protected:
    BadInput() {
        viewer_.hello({{"strict", true}});
        viewer_.update(kSmall);
        other_.hello();
        other_.update(kSmall);
        other_.ask({{"op", "stream.start"}});
        rev_ = viewer_.update(Json::object())["rev"];
    }

    Json errorTo(const std::string& text) {
        viewer_.text(text);
        const auto error = viewer_.textOf("error", 10'000);
        return error ? *error : Json::object();
    }

    // The connection answers, its document is as it was, and the neighbour's picture goes on changing.
    void expectAllGoesOn() {
        const std::uint32_t now = viewer_.update(Json::object())["rev"];
        EXPECT_EQ(now, rev_ + 1) << "something was applied";
        rev_ = now;
        x_ += 0.02;
        other_.update({{"lights", {{"key", {{"position", {x_, 4.0, 0.0}}}}}}});
        while (const auto picture = other_.frame(20'000)) {
            other_.ack(picture->header.frameSeq);
            if (picture->header.flags == 0) {
                return;
            }
        }
        FAIL() << "the other viewer's frames stopped";
    }

    ServerProcess server_;
    RawClient viewer_{server_.port()}, other_{server_.port()};
    std::uint32_t rev_ = 0;
    double x_ = 0.0;
};

TEST_F(BadInput, TextsThatAreNoMessages) {
    const std::vector<BadText> battery = {
        {"", "bad_message", ""},
        {"{", "bad_message", ""},
        {"[1,2,3]", "bad_message", ""},
        {"42", "bad_message", ""},
        {"{\"op\":\"update\",\"op\":\"update\"}", "bad_message", ""},
        {std::string(60, '[') + std::string(60, ']'), "bad_message", ""},
        {"{\"no\":\"op\"}", "bad_message", ""},
        {"{\"op\":7}", "", "op"},
        {"{\"op\":\"dance\"}", "unknown_op", ""},
        {"{\"op\":\"update\",\"id\":77}", "bad_request", "patch"},
        {"{\"op\":\"update\",\"id\":-1,\"patch\":{}}", "", "id"},
        {"{\"op\":\"update\",\"id\":1.5,\"patch\":{}}", "", "id"},
        {"{\"op\":\"update\",\"id\":99999999999,\"patch\":{}}", "", "id"},
        {"{\"op\":\"hello\",\"id\":5,\"client\":{\"name\":\"a\",\"version\":\"1\"},\"caps\":[],\"max_inflight\":2}", "bad_request", "op"},
        {"{\"op\":\"input\",\"seq\":1,\"t_us\":1,\"camera\":{\"eye\":[0,1]}}", "", "camera.eye"},
        {"{\"op\":\"ack\",\"seq\":999,\"recv_us\":1,\"decode_us\":1,\"paint_us\":1}", "out_of_range", "seq"},
        {"{\"op\":\"asset.end\",\"id\":6,\"asset\":44}", "bad_request", "asset"},
        {"{\"op\":\"asset.begin\",\"id\":6,\"sha256\":\"xyz\",\"size\":10,\"mime\":\"model/gltf-binary\"}", "", "sha256"},
        {"{\"op\":\"frame.request\",\"id\":6,\"still\":\"yes\"}", "bad_request", "still"},
    };
    for (const BadText& bad : battery) {
        const Json error = errorTo(bad.text);
        EXPECT_EQ(error.value("op", ""), "error") << bad.text;
        EXPECT_THAT(error.value("code", ""), HasSubstr(bad.code)) << bad.text << "\n" << error;
        EXPECT_THAT(error.value("field", ""), HasSubstr(bad.field)) << bad.text << "\n" << error;
        EXPECT_FALSE(error.value("message", "").empty()) << bad.text;
        EXPECT_FALSE(error.value("fatal", true)) << bad.text;
    }
    expectAllGoesOn();
}

TEST_F(BadInput, PatchesThatDoNotHold) {
    const std::vector<BadPatch> battery = {
        {R"({"camera":{"fov_y_deg":"wide"}})", "bad_request", "camera.fov_y_deg"},
        {R"({"camera":{"fov_y_deg":500}})", "out_of_range", "camera.fov_y_deg"},
        {R"({"camera":{"fov_y_deg":NaN}})", "bad_message", ""},
        {R"({"camera":{"fov_y_deg":1e999}})", "bad_message", ""},
        {R"({"camera":{"eye":[1e300,0,0]}})", "out_of_range", "camera.eye"},
        {R"({"camera":{"eye":[1,2,3],"target":[1,2,3]}})", "out_of_range", "camera.target"},
        {R"({"camera":{"eye":[0,5,0],"target":[0,0,0],"up":[0,1,0]}})", "out_of_range", "camera.up"},
        {R"({"scene":["builtin","atlantis"]})", "unsupported", "scene"},
        {R"({"scene":["file","/etc/passwd"]})", "", "scene"},
        {R"({"scene":["asset",")" + std::string(64, 'a') + R"("]})", "asset_missing", "scene"},
        {R"({"lights":{"sun":{"position":[0,1,0]}}})", "bad_request", "lights.sun"},
        {R"({"lights":{"key":{"direction":[0,0,0]}}})", "out_of_range", "lights.key.direction"},
        {R"({"lights":{"key":{"intensity":["lx",5]}}})", "bad_request", "lights.key.intensity"},
        {R"({"lights":{"key":{"intensity":["cd",-5]}}})", "out_of_range", "lights.key.intensity"},
        {R"({"lights":{"key":{"cookie":["texture",900]}}})", "out_of_range", "lights.key.cookie"},
        {R"({"materials":{"cheese":{"dispersion":["constant",1.5]}}})", "bad_request", "materials.cheese"},
        {R"({"transport":{"wavelengths":65}})", "out_of_range", "transport.wavelengths"},
        {R"({"transport":{"wavelengths":3.5}})", "", "transport.wavelengths"},
        {R"({"transport":{"map_size":1000000}})", "out_of_range", "transport.map_size"},
        {R"({"stream":{"width":5}})", "out_of_range", "stream.width"},
        {R"({"stream":{"width":4096,"height":4096}})", "out_of_range", "stream"},
        {R"({"stream":{"target":"no_such_pass"}})", "unsupported", "stream.target"},
        {R"({"stream":{"target":"spectral","encoding":"jpeg"}})", "bad_request", "stream.encoding"},
        {R"({"stream":{"encoding":"jpeg","sample":"f32"}})", "bad_request", "stream.sample"},
        {R"({"stream":{"encoding":"raw","sample":"f16"}})", "unsupported", "stream.sample"},
        {R"({"stream":{"encoding":"webp"}})", "unsupported", "stream.encoding"},
        {R"({"stream":{"target":"spectral","encoding":"zstd"}})", "bad_request", "stream.sample"},
        {R"({"colour":"blue"})", "unknown_field", "colour"},
        // One bad field among good ones: the good ones are not applied either.
        {R"({"camera":{"fov_y_deg":33},"environment":{"color":[1,2]}})", "", "environment.color"},
    };
    for (const BadPatch& bad : battery) {
        const Json error = errorTo(updateText(bad.patch));
        EXPECT_EQ(error.value("op", ""), "error") << bad.patch;
        EXPECT_THAT(error.value("code", ""), HasSubstr(bad.code)) << bad.patch << "\n" << error;
        EXPECT_THAT(error.value("field", ""), HasSubstr(bad.field)) << bad.patch << "\n" << error;
    }
    expectAllGoesOn();
}

TEST_F(BadInput, BinariesThatAreNoChunks) {
    const auto refused = [&](std::vector<std::uint8_t> bytes, std::string_view what) {
        viewer_.binary(bytes);
        const auto error = viewer_.textOf("error", 10'000);
        EXPECT_TRUE(error) << what;
        EXPECT_FALSE(error && error->value("fatal", true)) << what;
    };
    protocol::ChunkHeader header{.asset = 1, .payloadLen = 4};
    const auto encoded = protocol::encodeHeader(header);
    std::vector<std::uint8_t> chunk(encoded.begin(), encoded.end());
    refused({}, "empty");
    for (const std::size_t size : {1u, 3u, 8u, 23u}) {
        refused({chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(size)}, "cut header");
    }
    refused(chunk, "payload missing");
    chunk.insert(chunk.end(), {1, 2, 3, 4});
    refused(chunk, "no upload was begun");
    chunk.push_back(5);
    refused(chunk, "more than announced");
    std::vector<std::uint8_t> wrong = chunk;
    wrong[0] = 1;
    refused(wrong, "a frame is the server's to send");
    wrong = chunk;
    wrong[1] = 9;
    refused(wrong, "version");
    wrong = chunk;
    wrong[16] = wrong[17] = wrong[18] = wrong[19] = 0xff;
    refused(wrong, "4 GiB announced");
    expectAllGoesOn();
}

TEST_F(BadInput, AMessageInPiecesIsOneMessage) {
    const std::string message = updateText(R"({"camera":{"fov_y_deg":44}})");
    viewer_.send(0x1, message.substr(0, 10), false);
    viewer_.send(0x0, message.substr(10, 10), false);
    viewer_.send(0x0, message.substr(20), true);
    const auto reply = viewer_.textOf("ok", 10'000);
    ASSERT_TRUE(reply);
    EXPECT_EQ((*reply)["id"], 77);
}

// These end the connection that did it, with the code that says why; the neighbour does not notice.
TEST_F(BadInput, WhatEndsTheConnection) {
    const auto closeCode = [&](const std::function<void(RawClient&)>& misbehave) {
        RawClient client(server_.port());
        client.hello();
        misbehave(client);
        while (true) {
            const Message message = client.next(20'000);
            if (message.kind == Message::Kind::Close || message.kind == Message::Kind::Silence) {
                return message.closeCode;
            }
        }
    };
    EXPECT_EQ(closeCode([](RawClient& client) { client.text(std::string(70'000, ' ')); }), 1009) << "text too long";
    EXPECT_EQ(closeCode([](RawClient& client) { client.binary(std::vector<std::uint8_t>((1u << 20) + 1)); }), 1009);
    EXPECT_EQ(closeCode([](RawClient& client) { client.text("{\"op\":\"\xff\xfe\"}"); }), 1007) << "not UTF-8";
    EXPECT_EQ(closeCode([](RawClient& client) {
                  for (int i = 0; i < 3000; ++i) {  // most of them while the server says goodbye
                      client.json({{"op", "ping"}, {"t_us", i}});
                  }
              }),
              4429)
        << "too many messages, and who sends them is told so";
    EXPECT_EQ(closeCode([](RawClient& client) {
                  client.send(0x1, std::string(40'000, ' '), false);
                  client.send(0x0, std::string(40'000, ' '), false);
              }),
              1009)
        << "too long in pieces";
    expectAllGoesOn();
}

// Below the messages: frames that RFC 6455 does not allow, and requests that are no HTTP.
TEST_F(BadInput, GarbageOnTheWire) {
    const std::vector<std::string> frames = {
        std::string("\x81\x05hello", 7),                                   // not masked
        std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14),  // announces 2^63 bytes
        std::string("\x81\xff\0\0\0\0\x40\0\0\0\0\0\0\0", 14),                 // announces 1 GiB
        std::string("\x89\xfe\x01\0\0\0\0\0", 8) + std::string(256, 'p'),  // a ping with more than 125 bytes
        std::string("\xf1\x80\0\0\0\0", 6),                              // reserved bits
        std::string("\x80\x80\0\0\0\0", 6),                              // a continuation of nothing
        std::string("\x87\x80\0\0\0\0", 6),                              // an opcode there is not
        std::string("\x88\x81\0\0\0\0x", 7),                             // a close with half a code
        std::string(5000, '\xff'),
    };
    for (const std::string& frame : frames) {
        RawClient client(server_.port());
        client.hello();
        client.bytes(frame);
        client.bytes("\x81");
    }
    const std::vector<std::string> requests = {
        "x", "GET", "GET / HTTP/9.9\r\n\r\n", std::string(20'000, 'a') + "\r\n\r\n",
        "GET /" + std::string(30'000, 'b') + " HTTP/1.1\r\n\r\n", std::string(100, '\0'), "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"};
    for (const std::string& request : requests) {
        sendRequest(server_.port(), request);
    }
    expectAllGoesOn();
}

TEST_F(BadInput, TheNinthViewerIsTurnedAway) {
    std::vector<std::unique_ptr<RawClient>> more;
    for (int i = 0; i < 6; ++i) {
        more.push_back(std::make_unique<RawClient>(server_.port()));
        more.back()->hello();
    }
    RawClient ninth(server_.port());
    ninth.json({{"op", "hello"}, {"id", 1}, {"client", {{"name", "t"}, {"version", "1"}}}, {"caps", Json::array()}, {"max_inflight", 2}});
    const auto error = ninth.textOf("error", 10'000);
    ASSERT_TRUE(error);
    EXPECT_EQ((*error)["code"], "busy");
    EXPECT_EQ(ninth.next().closeCode, 4429);
    more.pop_back();
    RawClient again(server_.port());
    again.hello();
}

TEST_F(BadInput, HelloComesFirst) {
    RawClient client(server_.port());
    client.json({{"op", "frame.request"}, {"id", 1}});
    const auto error = client.textOf("error", 10'000);
    ASSERT_TRUE(error);
    EXPECT_THAT((*error)["message"], HasSubstr("hello"));
    client.hello();
    EXPECT_EQ(client.update(kSmall)["op"], "ok");
}

TEST_F(BadInput, SilenceBeforeHelloEnds) {
    RawClient client(server_.port());
    EXPECT_TRUE(client.textOf("error", 10'000));
    EXPECT_EQ(client.next().closeCode, 4408);
}

}  // namespace
}  // namespace caustream::e2e
