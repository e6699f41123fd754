#include "protocol/client_messages.h"
#include "protocol/codec.h"

namespace caustream::protocol {
namespace {

Resume decodeResume(const Item& item) {
    Fields in(item);
    Resume resume;
    resume.session = in.at("session").text(kNameBytes, 1);
    if (const auto v = in.find("state")) resume.state = v->object();
    if (const auto v = in.find("rev")) resume.rev = v->u32();
    if (const auto v = in.find("input_seq")) resume.inputSeq = v->u32();
    in.finish();
    return resume;
}

ClientMessage decodeHello(Fields& in) {
    Hello hello;
    hello.id = requestId(in);
    // A hello speaks for itself: strictness starts with it.
    if (const auto v = in.find("strict")) hello.strict = v->boolean();
    in.beStrict(hello.strict);
    if (const auto v = in.find("token")) hello.token = v->text(kTextBytes);
    const Item client = in.at("client");
    Fields about(client);
    hello.clientName = about.at("name").text(kNameBytes, 1);
    hello.clientVersion = about.at("version").text(kNameBytes);
    about.finish();
    if (const auto v = in.find("caps")) hello.caps = v->texts(64, 64);
    if (const auto v = in.find("max_inflight")) hello.maxInflight = v->u32(1, 8);
    if (const auto v = in.find("role")) hello.role = v->oneOf(kRoles);
    if (const auto v = in.find("follow")) hello.follow = v->text(kNameBytes, 1);
    if (const auto v = in.find("resume")) hello.resume = decodeResume(*v);
    return hello;
}

ClientMessage decodeUpdate(Fields& in) {
    Update update;
    if (const auto v = in.find("id")) update.id = v->u32(1);
    update.patch = in.at("patch").object();
    return update;
}

ClientMessage decodeInput(Fields& in) {
    Input input;
    input.seq = in.at("seq").u32(1);
    input.tUs = in.at("t_us").integer(0, kMaxSafeInteger);
    for (const char* part : {"camera", "lights"})
        if (const auto v = in.find(part)) input.patch[part] = v->object();
    return input;
}

ClientMessage decodeStreamStart(Fields& in) {
    StreamStart start{requestId(in)};
    if (const auto v = in.find("stats")) start.stats = v->boolean();
    return start;
}

ClientMessage decodeStreamPause(Fields& in) {
    return StreamPause{requestId(in)};
}
ClientMessage decodeStreamResume(Fields& in) {
    return StreamResume{requestId(in)};
}

ClientMessage decodeFrameRequest(Fields& in) {
    FrameRequest request{requestId(in)};
    if (const auto v = in.find("still")) request.still = v->boolean();
    if (const auto v = in.find("converge")) request.converge = v->boolean();
    return request;
}

ClientMessage decodeAck(Fields& in) {
    return Ack{in.at("seq").u32(1), in.at("recv_us").integer(0, kMaxSafeInteger), in.at("decode_us").u32(),
               in.at("paint_us").u32()};
}

ClientMessage decodeAssetBegin(Fields& in) {
    AssetBegin begin{requestId(in), in.at("sha256").sha256(), in.at("size").integer(1, kMaxSafeInteger)};
    if (const auto v = in.find("mime")) begin.mime = v->text(kNameBytes, 1);
    return begin;
}

ClientMessage decodeAssetEnd(Fields& in) {
    return AssetEnd{requestId(in), in.at("asset").u32()};
}
ClientMessage decodeAssetAbort(Fields& in) {
    return AssetAbort{in.at("asset").u32()};
}
ClientMessage decodeRecord(Fields& in) {
    return Record{requestId(in), in.at("on").boolean()};
}
ClientMessage decodePing(Fields& in) {
    return Ping{in.at("t_us").integer(0, kMaxSafeInteger)};
}

constexpr Op<ClientMessage> kOps[] = {
    {"hello", decodeHello},
    {"update", decodeUpdate},
    {"input", decodeInput},
    {"stream.start", decodeStreamStart},
    {"stream.pause", decodeStreamPause},
    {"stream.resume", decodeStreamResume},
    {"frame.request", decodeFrameRequest},
    {"ack", decodeAck},
    {"asset.begin", decodeAssetBegin},
    {"asset.end", decodeAssetEnd},
    {"asset.abort", decodeAssetAbort},
    {"record", decodeRecord},
    {"ping", decodePing},
};

}  // namespace

tl::expected<ClientMessage, DecodeError> decodeClientMessage(std::string_view text, const Limits& limits, bool strict) {
    auto message = decodeByOp<ClientMessage>(text, limits.textBytes, limits.depth, strict, kOps);
    if (!message) return message;
    if (const auto* begin = std::get_if<AssetBegin>(&*message); begin && begin->size > limits.assetBytes)
        return tl::unexpected(DecodeError{ErrorCode::TooLarge,
                                          "an asset may have " + std::to_string(limits.assetBytes) + " bytes", "size",
                                          begin->id});
    return message;
}

std::string encode(const Hello& hello) {
    Json json = {{"op", "hello"},
                 {"id", hello.id},
                 {"client", {{"name", hello.clientName}, {"version", hello.clientVersion}}},
                 {"caps", hello.caps},
                 {"max_inflight", hello.maxInflight},
                 {"strict", hello.strict},
                 {"role", nameOf(kRoles, hello.role)}};
    putOptional(json, "token", hello.token);
    putOptional(json, "follow", hello.follow);
    if (hello.resume) {
        Json& resume = json["resume"] = {{"session", hello.resume->session}};
        putOptional(resume, "state", hello.resume->state);
        putOptional(resume, "rev", hello.resume->rev);
        putOptional(resume, "input_seq", hello.resume->inputSeq);
    }
    return text(json);
}

std::string encode(const Update& update) {
    Json json = {{"op", "update"}, {"patch", update.patch}};
    putOptional(json, "id", update.id);
    return text(json);
}

std::string encode(const Input& input) {
    Json json = {{"op", "input"}, {"seq", input.seq}, {"t_us", input.tUs}};
    for (const char* part : {"camera", "lights"})
        if (input.patch.contains(part)) json[part] = input.patch[part];
    return text(json);
}

std::string encode(const StreamStart& start) {
    return text({{"op", "stream.start"}, {"id", start.id}, {"stats", start.stats}});
}
std::string encode(const StreamPause& pause) {
    return text({{"op", "stream.pause"}, {"id", pause.id}});
}
std::string encode(const StreamResume& resume) {
    return text({{"op", "stream.resume"}, {"id", resume.id}});
}
std::string encode(const FrameRequest& request) {
    return text({{"op", "frame.request"}, {"id", request.id}, {"still", request.still}, {"converge", request.converge}});
}
std::string encode(const Ack& ack) {
    return text({{"op", "ack"},
                 {"seq", ack.seq},
                 {"recv_us", ack.recvUs},
                 {"decode_us", ack.decodeUs},
                 {"paint_us", ack.paintUs}});
}
std::string encode(const AssetBegin& begin) {
    return text({{"op", "asset.begin"},
                 {"id", begin.id},
                 {"sha256", begin.sha256},
                 {"size", begin.size},
                 {"mime", begin.mime}});
}
std::string encode(const AssetEnd& end) {
    return text({{"op", "asset.end"}, {"id", end.id}, {"asset", end.asset}});
}
std::string encode(const AssetAbort& abort) {
    return text({{"op", "asset.abort"}, {"asset", abort.asset}});
}
std::string encode(const Record& record) {
    return text({{"op", "record"}, {"id", record.id}, {"on", record.on}});
}
std::string encode(const Ping& ping) {
    return text({{"op", "ping"}, {"t_us", ping.tUs}});
}

std::string encode(const ClientMessage& message) {
    return std::visit([](const auto& one) { return encode(one); }, message);
}

}  // namespace caustream::protocol
