#include "client/connection/connection_impl.h"

#include <algorithm>
#include <utility>

#include "client/connection/backoff.h"
#include "client/connection/closing.h"
#include "protocol/patch.h"

namespace caustream::connection {
namespace {

constexpr std::uint64_t kPingEveryUs = 1'000'000;
constexpr std::uint64_t kDeadUs =
    12'000'000;  // silence, though there were pings: the connection is dead and no one said so

}  // namespace

std::uint32_t Connection::Impl::nextId() {
    std::scoped_lock lock(mutex);
    return ++lastId;
}

double Connection::Impl::chance() {
    return std::uniform_real_distribution<double>()(random);
}

std::string Connection::Impl::assetShown() const {
    std::scoped_lock lock(mutex);
    const Json scene = document.wanted().value("scene", Json{});
    return scene.is_array() && scene.size() == 2 && scene[0] == "asset" ? scene[1].get<std::string>() : std::string{};
}

void Connection::Impl::newsArrived() {
    {
        std::scoped_lock lock(mutex);
        isNew = true;
    }
    news.notify_all();
    if (options.wake) options.wake();
}

void Connection::Impl::tell(Event event) {
    {
        std::scoped_lock lock(mutex);
        events.push_back(std::move(event));
    }
    newsArrived();
}

void Connection::Impl::hello() {
    expected.clear();
    info = std::make_shared<protocol::StreamInfo>();
    open = true;
    welcomed = helloRefused = false;
    refusal.clear();
    lastHeardUs = nowUs();
    helloId = nextId();
    protocol::Hello message{
        .id = helloId, .token = options.token, .clientName = options.clientName, .clientVersion = "0.1.0"};
    message.caps = {"jpeg", "png", "raw", "zstd", "shuffle", "f16", "f32"};
    message.maxInflight = options.maxInflight;
    message.strict = options.strict;
    if (!options.follow.empty()) {
        message.role = protocol::Role::View;
        message.follow = options.follow;
    }
    resuming = !session.empty();
    if (resuming) {
        std::scoped_lock lock(mutex);
        Json state = document.taken();
        // Whom we follow may come back after us: until then its scene is as we saw it last.
        if (Json both = theirs; !both.empty()) {
            both.merge_patch(state);
            if (both.dump().size() < limits.stateBytes) state = std::move(both);
        }
        message.resume = protocol::Resume{
            .session = session, .state = std::move(state), .rev = rev, .inputSeq = inputSeq};
    }
    socket->sendText(protocol::encode(message));
}

void Connection::Impl::onWelcome(const protocol::Welcome& welcome) {
    welcomed = true;
    session = welcome.session;
    rev = welcome.rev;
    limits = welcome.limits;
    serverHas = resuming ? welcome.state : Json::object();
    socket->settled();

    // What the document shows goes first, whole or not at all; so does a file that the first picture is to be of.
    const std::string asset = assetShown();
    const bool lacking = !resuming || std::ranges::find(welcome.missingAssets, asset) != welcome.missingAssets.end();
    if (const Bytes bytes = asset.empty() || !lacking ? nullptr : kept.get(asset)) return beginUpload(bytes, true);
    if (wantedFile && !resuming) return beginUpload(wantedFile, false);
    replay();
    if (wantedFile) beginUpload(wantedFile, false);
}

// Says what this server does not know yet: it may be another one than before.
void Connection::Impl::replay() {
    std::vector<std::string> messages;
    {
        std::scoped_lock lock(mutex);
        const std::vector<std::string> members =
            options.follow.empty() ? std::vector<std::string>{} : std::vector<std::string>{"camera", "stream"};
        for (const Json& patch : document.replay(serverHas, members)) {
            document.sent(++lastId, patch);
            messages.push_back(protocol::encode(protocol::Update{.id = lastId, .patch = patch}));
        }
        if (streaming)
            messages.push_back(protocol::encode(protocol::StreamStart{.id = ++lastId, .stats = statsWanted}));
        if (recording) messages.push_back(protocol::encode(protocol::Record{.id = recordId = ++lastId, .on = true}));
        ready = true;
    }
    for (const auto& message : messages) socket->sendText(message);
}

void Connection::Impl::beginUpload(const Bytes& bytes, bool isRestored) {
    Upload::Wire wire{[this] { return nextId(); }, [this](const std::string& text) { socket->sendText(text); },
                      [this](auto head, auto payload) { socket->sendBinary(head, payload); }};
    upload = std::make_unique<Upload>(bytes, std::move(wire));
    restoring = isRestored;
    upload->begin(limits);
}

// It is there, or was refused. One that was lost with the document's scene lets all wait that the document says.
void Connection::Impl::uploadEnded() {
    const bool restored = std::exchange(restoring, false);
    if (upload->done()) kept.put(upload->sha256(), upload->bytes(), limits.assetBytes);
    if (!restored) {
        wantedFile = nullptr;
        if (upload->done()) {
            const protocol::SceneRef scene{.kind = protocol::SceneRef::Kind::Asset, .name = upload->sha256()};
            const Json patch = protocol::sceneChange(scene);
            std::scoped_lock lock(mutex);
            if (ready) {
                document.sent(++lastId, patch);
                socket->sendText(protocol::encode(protocol::Update{.id = lastId, .patch = patch}));
            } else {
                document.keep(patch);
            }
        }
    }
    std::unique_lock lock(mutex);
    const bool waited = !ready;
    lock.unlock();
    if (waited) replay();
    if (restored && wantedFile) beginUpload(wantedFile, false);
}

void Connection::Impl::onOk(const protocol::Ok& ok) {
    if (ok.rev) rev = *ok.rev;
    if (ok.frame) expected[ok.frame->frameSeq] = ok.frame->mapHash;
    {
        std::scoped_lock lock(mutex);
        document.answered(ok.id, true);
    }
    if (upload && upload->take(ok)) {
        tell(UploadProgress{upload->confirmed(), upload->size()});
        if (upload->done()) uploadEnded();
    }
    tell(ok);
}

void Connection::Impl::onError(const protocol::ErrorMessage& error) {
    if (error.id) {
        std::scoped_lock lock(mutex);
        document.answered(*error.id, false);
        if (*error.id == recordId) recording = false;
    }
    if (error.fatal && error.retryMs) comeBack = comeBackMs(*error.retryMs, *error.retryMs / 2, chance());
    const bool ofHello = error.id == helloId && !welcomed && !error.fatal;
    if (ofHello && resuming) {
        // What was right for the last server may be wrong for this one: a fresh session, then the document as a change.
        session.clear();
        hello();
    } else if (ofHello) {
        // Whom we follow may not be there yet; what a server cannot do, it will not be able to in a second.
        helloRefused = error.code == protocol::ErrorCode::Unsupported;
        refusal = error.message;
        socket->close(1000, "");
    }
    tell(error);
    if (upload && upload->take(error)) uploadEnded();
}

void Connection::Impl::onText(std::string_view text) {
    lastHeardUs = nowUs();
    auto message = protocol::decodeServerMessage(text, limits);
    if (!message) return tell(BadMessage{"a message was not understood: " + message.error().message});
    std::visit(
        [this]<class T>(T& value) {
            if constexpr (std::is_same_v<T, protocol::Welcome>) {
                onWelcome(value);
                tell(std::move(value));
            } else if constexpr (std::is_same_v<T, protocol::Ok>) {
                onOk(value);
            } else if constexpr (std::is_same_v<T, protocol::ErrorMessage>) {
                onError(value);
            } else if constexpr (std::is_same_v<T, protocol::StateMessage>) {
                rev = value.rev;
                if (!options.follow.empty()) {
                    theirs = value.state;
                    for (const char* ours : {"camera", "stream"}) theirs.erase(ours);
                }
                {
                    std::scoped_lock lock(mutex);
                    document.prune(value.state);
                }
                tell(std::move(value));
            } else if constexpr (std::is_same_v<T, protocol::StreamInfo>) {
                info = std::make_shared<protocol::StreamInfo>(value);
                tell(std::move(value));
            } else if constexpr (std::is_same_v<T, protocol::AssetCredit>) {
                if (!upload) return;
                upload->take(value);
                tell(UploadProgress{upload->confirmed(), upload->size()});
            } else if constexpr (std::is_same_v<T, protocol::Pong>) {
                tell(RoundTrip{static_cast<double>(lastHeardUs - std::min(value.tUs, lastHeardUs)) / 1000.0, value.tUs,
                               value.serverUs, lastHeardUs});
            } else if constexpr (std::is_same_v<T, protocol::Goaway>) {
                comeBack = comeBackMs(value.reconnectMs, value.jitterMs, chance());
                options.address = anyServer(options.address);  // the one that was asked for is going
                tell(std::move(value));
            } else {
                tell(std::move(value));
            }
        },
        *message);
}

void Connection::Impl::onBinary(std::span<const std::uint8_t> message) {
    const std::uint64_t received = lastHeardUs = nowUs();
    const auto header = protocol::decodeFrameHeader(message, limits);
    if (!header) return tell(BadMessage{"a frame was not understood: " + header.error().message});
    const auto payload = message.subspan(header->headerLen, header->payloadLen);
    auto image = decoder.decode(*header, payload);
    if (!image) {
        // It will never be shown, but it must not hold its slot in the window.
        socket->sendText(protocol::encode(protocol::Ack{.seq = header->frameSeq, .recvUs = received}));
        return tell(BadMessage{image.error()});
    }

    Frame frame{.header = *header, .info = info, .image = std::move(*image), .receivedUs = received};
    frame.decodeUs = static_cast<std::uint32_t>(nowUs() - received);
    if (options.keepEncoded) frame.encoded.assign(payload.begin(), payload.end());
    if (const auto found = expected.find(header->frameSeq); found != expected.end()) {
        frame.mapHash = found->second;
        expected.erase(found);
        requested.put(std::move(frame));
    } else {
        newest.put(std::move(frame));
    }
    newsArrived();
}

void Connection::Impl::onClosed(int code, const std::string& why) {
    open = welcomed = restoring = false;
    upload.reset();
    {
        std::scoped_lock lock(mutex);
        document.lost();
        ready = false;
    }
    newest.take();  // its slot in the window went with the connection
    const Closing closing = closingOf(code, why);
    const bool retry = closing.retry && !helloRefused;
    if (!retry) socket->reconnectIn(-1);
    if (const int ms = std::exchange(comeBack, -1); ms >= 0 && retry) socket->reconnectIn(ms);
    tell(Disconnected{code, refusal.empty() ? closing.why : std::exchange(refusal, ""), retry, socket->waitMs()});
}

void Connection::Impl::onTick() {
    if (!open) return;
    const std::uint64_t now = nowUs();
    if (now - lastHeardUs > kDeadUs) {
        socket->close(static_cast<int>(protocol::CloseCode::Timeout), "no answer");
    } else if (welcomed && now - lastPingUs > kPingEveryUs) {
        lastPingUs = now;
        socket->sendText(protocol::encode(protocol::Ping{.tUs = now}));
    }
}

}  // namespace caustream::connection
