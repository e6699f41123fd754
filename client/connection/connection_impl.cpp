#include "client/connection/connection_impl.h"
#include "protocol/patch.h"

#include <algorithm>
#include <random>

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

Json Connection::Impl::documentLocked() const {
    Json document = confirmed;
    for (const auto& [id, patch] : unanswered) document.merge_patch(patch);
    return document;
}

bool Connection::Impl::documentShows(const std::string& asset) const {
    std::scoped_lock lock(mutex);
    const Json document = documentLocked();
    return document.contains("scene") && document["scene"] == Json{"asset", asset};
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
    welcomed = false;
    lastHeardUs = nowUs();
    helloId = nextId();
    protocol::Hello message{
        .id = helloId, .token = options.token, .clientName = options.clientName, .clientVersion = "0.1.0"};
    message.caps = {"jpeg", "png", "raw", "f16", "f32"};
    message.maxInflight = options.maxInflight;
    message.strict = options.strict;
    if (!session.empty()) message.resume = protocol::Resume{.session = session};
    socket->sendText(protocol::encode(message));
}

void Connection::Impl::onWelcome(const protocol::Welcome& welcome) {
    welcomed = true;
    session = welcome.session;
    limits = welcome.limits;
    // An asset that the document names goes first, whole or not at all; the server says if it still has it.
    if (upload && !upload->failed() && (!uploadShown || documentShows(upload->sha256())))
        upload->begin(limits);
    else
        replay();
}

// Says everything again: this server may be another one than before.
void Connection::Impl::replay() {
    std::vector<std::string> messages;
    {
        std::scoped_lock lock(mutex);
        const Json document = documentLocked();
        confirmed = Json::object();
        unanswered.clear();
        if (!document.empty()) {
            unanswered[++lastId] = document;
            messages.push_back(protocol::encode(protocol::Update{.id = lastId, .patch = document}));
        }
        if (streaming)
            messages.push_back(protocol::encode(protocol::StreamStart{.id = ++lastId, .stats = statsWanted}));
        ready = true;
    }
    for (const auto& message : messages) socket->sendText(message);
}

void Connection::Impl::onOk(const protocol::Ok& ok) {
    if (upload && upload->take(ok)) {
        tell(UploadProgress{upload->confirmed(), upload->size()});
        if (upload->done()) afterUpload();
    }
    if (ok.frame) expected[ok.frame->frameSeq] = ok.frame->mapHash;
    {
        std::scoped_lock lock(mutex);
        if (const auto found = unanswered.find(ok.id); found != unanswered.end()) {
            confirmed.merge_patch(found->second);
            unanswered.erase(found);
        }
    }
    tell(ok);
}

void Connection::Impl::onError(const protocol::ErrorMessage& error) {
    const bool ofUpload = upload && upload->take(error);
    if (error.id) {
        std::scoped_lock lock(mutex);
        unanswered.erase(*error.id);
    }
    // A session that is not ours to resume: the next hello asks for a new one.
    if ((error.id == helloId && !welcomed) || error.code == protocol::ErrorCode::SessionTaken) session.clear();
    tell(error);
    if (!ofUpload || !welcomed) return;
    std::unique_lock lock(mutex);
    const bool waited = !ready;  // the document, for the asset
    lock.unlock();
    if (waited) replay();
}

// The first time, the uploaded scene is shown; on a server that had forgotten it, the document already names it.
void Connection::Impl::afterUpload() {
    const bool show = !std::exchange(uploadShown, true);
    std::unique_lock lock(mutex);
    if (show) {
        const protocol::SceneRef scene{.kind = protocol::SceneRef::Kind::Asset, .name = upload->sha256()};
        Json patch = protocol::sceneChange(scene);
        if (ready) socket->sendText(protocol::encode(protocol::Update{.id = lastId + 1, .patch = patch}));
        unanswered[++lastId] = std::move(patch);
    }
    const bool waited = !ready;
    lock.unlock();
    if (waited) replay();
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
            } else if constexpr (std::is_same_v<T, protocol::StreamInfo>) {
                info = std::make_shared<protocol::StreamInfo>(value);
                tell(std::move(value));
            } else if constexpr (std::is_same_v<T, protocol::AssetCredit>) {
                if (!upload) return;
                upload->take(value);
                tell(UploadProgress{upload->confirmed(), upload->size()});
            } else if constexpr (std::is_same_v<T, protocol::Pong>) {
                tell(RoundTrip{static_cast<double>(lastHeardUs - std::min(value.tUs, lastHeardUs)) / 1000.0});
            } else if constexpr (std::is_same_v<T, protocol::Goaway>) {
                static std::minstd_rand random{std::random_device{}()};
                comeBackMs = static_cast<int>(std::min<std::uint64_t>(
                    60'000u, std::uint64_t{value.reconnectMs} + random() % (std::uint64_t{value.jitterMs} + 1)));
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
    open = welcomed = false;
    {
        std::scoped_lock lock(mutex);
        ready = false;
    }
    newest.take();  // its slot in the window went with the connection
    if (code == static_cast<int>(protocol::CloseCode::SessionTaken)) session.clear();
    // What a person must put right does not get better by asking again and again.
    const bool hopeless = code == static_cast<int>(protocol::CloseCode::AuthRequired) ||
                          code == static_cast<int>(protocol::CloseCode::Forbidden) ||
                          code == static_cast<int>(protocol::CloseCode::Version);
    if (hopeless) socket->close(1000, "", false);
    if (const int ms = std::exchange(comeBackMs, -1); ms >= 0) socket->reconnectIn(ms);
    tell(Disconnected{code, why, !hopeless});
}

void Connection::Impl::onTick() {
    if (!open) return;
    const std::uint64_t now = nowUs();
    if (now - lastHeardUs > kDeadUs) {
        socket->close(static_cast<int>(protocol::CloseCode::Timeout), "no answer", true);
    } else if (welcomed && now - lastPingUs > kPingEveryUs) {
        lastPingUs = now;
        socket->sendText(protocol::encode(protocol::Ping{.tUs = now}));
    }
}

}  // namespace caustream::connection
