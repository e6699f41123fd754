#include "client/connection/connection.h"

#include "client/connection/connection_impl.h"
#include "protocol/patch.h"

namespace caustream::connection {

std::uint64_t nowUs() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

Connection::Connection(Options options) : impl_(std::make_unique<Impl>()) {
    Impl* impl = impl_.get();
    impl->options = std::move(options);
    SocketHandlers handlers;
    handlers.opened = [impl] { impl->hello(); };
    handlers.closed = [impl](int code, const std::string& why) { impl->onClosed(code, why); };
    handlers.text = [impl](std::string_view text) { impl->onText(text); };
    handlers.binary = [impl](std::span<const std::uint8_t> bytes) { impl->onBinary(bytes); };
    handlers.tick = [impl] { impl->onTick(); };
    impl->socket = std::make_unique<Socket>(impl->options.address, impl->options.caFile, std::move(handlers));
    impl->socket->start();
}

Connection::~Connection() {
    impl_->socket.reset();
}

tl::expected<std::uint32_t, protocol::DecodeError> Connection::update(const Json& patch) {
    std::scoped_lock lock(impl_->mutex);
    if (auto applied = protocol::applyPatch(impl_->document.wanted(), patch, {}, impl_->options.strict); !applied)
        return tl::make_unexpected(applied.error());
    if (!impl_->ready) {
        impl_->document.keep(patch);
        return 0u;
    }
    const std::uint32_t id = ++impl_->lastId;
    impl_->document.sent(id, patch);
    impl_->socket->sendText(protocol::encode(protocol::Update{.id = id, .patch = patch}));
    return id;
}

tl::expected<std::uint32_t, protocol::DecodeError> Connection::input(const Json& patch) {
    std::scoped_lock lock(impl_->mutex);
    if (auto applied = protocol::applyPatch(impl_->document.wanted(), patch, {}, impl_->options.strict); !applied)
        return tl::make_unexpected(applied.error());
    const std::uint32_t seq = ++impl_->inputSeq;
    if (!impl_->ready) {
        impl_->document.keep(patch);
        return seq;
    }
    impl_->document.moved(patch);
    impl_->socket->sendText(protocol::encode(protocol::Input{.seq = seq, .tUs = nowUs(), .patch = patch}));
    return seq;
}

Json Connection::document() const {
    std::scoped_lock lock(impl_->mutex);
    return impl_->document.wanted();
}

void Connection::showFile(std::vector<std::uint8_t> glb) {
    auto bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(glb));
    impl_->socket->post([impl = impl_.get(), bytes] {
        impl->wantedFile = bytes;
        if (impl->welcomed && !impl->restoring) impl->beginUpload(bytes, false);
    });
}

void Connection::startStream(bool stats) {
    std::scoped_lock lock(impl_->mutex);
    impl_->streaming = true;
    impl_->statsWanted = stats;
    if (impl_->ready)
        impl_->socket->sendText(protocol::encode(protocol::StreamStart{.id = ++impl_->lastId, .stats = stats}));
}

void Connection::pauseStream() {
    std::scoped_lock lock(impl_->mutex);
    impl_->streaming = false;
    if (impl_->ready) impl_->socket->sendText(protocol::encode(protocol::StreamPause{.id = ++impl_->lastId}));
}

std::uint32_t Connection::requestFrame(bool still, bool converge) {
    std::scoped_lock lock(impl_->mutex);
    if (!impl_->ready) return 0;
    impl_->socket->sendText(protocol::encode(protocol::FrameRequest{.id = ++impl_->lastId, .still = still, .converge = converge}));
    return impl_->lastId;
}

std::uint32_t Connection::record(bool on) {
    std::scoped_lock lock(impl_->mutex);
    impl_->recording = on;
    if (!impl_->ready) return 0;
    impl_->recordId = ++impl_->lastId;
    impl_->socket->sendText(protocol::encode(protocol::Record{.id = impl_->recordId, .on = on}));
    return impl_->recordId;
}

void Connection::reconnect() {
    impl_->socket->post([impl = impl_.get()] {
        if (!impl->open) impl->socket->reconnectIn(0);
    });
}

void Connection::acknowledge(const Frame& frame, std::uint32_t paintUs) {
    impl_->socket->sendText(protocol::encode(protocol::Ack{
        .seq = frame.header.frameSeq, .recvUs = frame.receivedUs, .decodeUs = frame.decodeUs, .paintUs = paintUs}));
}

std::optional<Frame> Connection::takeFrame() {
    return impl_->newest.take();
}

std::optional<Frame> Connection::takeRequested() {
    return impl_->requested.take();
}

std::vector<Event> Connection::takeEvents() {
    std::scoped_lock lock(impl_->mutex);
    return std::exchange(impl_->events, {});
}

void Connection::wait(std::chrono::milliseconds longest) {
    std::unique_lock lock(impl_->mutex);
    impl_->news.wait_for(lock, longest, [this] { return impl_->isNew; });
    impl_->isNew = false;
}

}  // namespace caustream::connection
