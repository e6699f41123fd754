#include "client/connection/socket.h"

#include <libwebsockets.h>
#include <openssl/x509_vfy.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <deque>
#include <mutex>
#include <random>
#include <thread>

#include "client/connection/backoff.h"
#include "client/connection/closing.h"

namespace caustream::connection {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxText = 4u << 20;               // a resolved scene with thousands of materials
constexpr std::size_t kMaxBinary = (256u << 20) + 4096;  // the largest frame payload there is, and its header
constexpr lws_usec_t kTickUs = 100'000;
constexpr auto kFarewell = std::chrono::milliseconds(300);  // for the close frame to leave when we end

struct Outgoing {
    bool binary;
    std::vector<unsigned char> bytes;  // LWS_PRE bytes that the library fills, then the message; masked in place
};

std::string certificateProblem(int error) {
    const bool name = error == X509_V_ERR_HOSTNAME_MISMATCH || error == X509_V_ERR_IP_ADDRESS_MISMATCH;
    return std::string(X509_verify_cert_error_string(error)) +
           (name ? "; use the name or address that it is made out for" : "; --ca FILE names the authority that signed it");
}

}  // namespace

struct Socket::Impl {
    Address address;
    std::string caFile;
    SocketHandlers handlers;
    std::thread thread;
    std::atomic<bool> stop{false};
    lws_context* context = nullptr;  // made before the thread starts; only lws_cancel_service from elsewhere

    std::mutex mutex;
    std::deque<Outgoing> queue;                 // guarded by mutex
    std::vector<std::function<void()>> posted;  // guarded by mutex
    bool open = false;                          // guarded by mutex

    // The socket's thread only.
    lws* wsi = nullptr;
    bool attempting = false, again = true, closeAsked = false;
    int closeCode = 0, peerCode = 0;
    Backoff backoff;
    std::string closeWhy, certificate;  // certificate: what is wrong with the server's
    Clock::time_point nextAttempt{};
    std::vector<std::uint8_t> received;
    std::mt19937 random{std::random_device{}()};
    // The timer's record and its owner, in this order: the callback gets the first and finds the second.
    struct Tick {
        lws_sorted_usec_list_t list{};
        Impl* owner = nullptr;
    } tick;

    static const lws_protocols* protocols();
    static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length);
    static void onTick(lws_sorted_usec_list_t* list);
    void run();
    void attempt();
    void ended(const std::string& why);
    int receive(const char* bytes, std::size_t length);
    int write();
    void enqueue(Outgoing message);
    void runPosted();
};

const lws_protocols* Socket::Impl::protocols() {
    static const lws_protocols list[] = {
        {"caustream.v1", callback, 0, 64 * 1024, 0, nullptr, 4u << 20},
        {nullptr, nullptr, 0, 0, 0, nullptr, 0},
    };
    return list;
}

Socket::Socket(Address address, const std::string& caFile, SocketHandlers handlers) : impl_(std::make_unique<Impl>()) {
    impl_->address = std::move(address);
    impl_->caFile = caFile;
    impl_->handlers = std::move(handlers);
    impl_->tick.owner = impl_.get();

    lws_set_log_level(0, nullptr);  // a library is silent; what goes wrong is said through `closed`
    lws_context_creation_info info{};
    info.port = CONTEXT_PORT_NO_LISTEN;
    info.protocols = Impl::protocols();
    info.gid = info.uid = static_cast<gid_t>(-1);
    info.pt_serv_buf_size = 64 * 1024;
    info.timeout_secs = 10;
    info.user = impl_.get();
    info.options = LWS_SERVER_OPTION_VALIDATE_UTF8;
    if (impl_->address.tls) {
        info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
        if (!caFile.empty()) {
            info.client_ssl_ca_filepath = impl_->caFile.c_str();
            info.options |= LWS_SERVER_OPTION_DISABLE_OS_CA_CERTS;
        }
    }
    impl_->context = lws_create_context(&info);
}

void Socket::start() {
    if (impl_->context) impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

Socket::~Socket() {
    if (!impl_->context) return;
    impl_->stop = true;
    lws_cancel_service(impl_->context);
    if (impl_->thread.joinable()) impl_->thread.join();
    lws_context_destroy(impl_->context);
}

void Socket::sendText(std::string_view message) {
    Outgoing out{false, std::vector<unsigned char>(LWS_PRE + message.size())};
    std::memcpy(out.bytes.data() + LWS_PRE, message.data(), message.size());
    impl_->enqueue(std::move(out));
}

void Socket::sendBinary(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload) {
    Outgoing out{true, std::vector<unsigned char>(LWS_PRE + head.size() + payload.size())};
    std::ranges::copy(head, out.bytes.begin() + LWS_PRE);
    std::ranges::copy(payload, out.bytes.begin() + LWS_PRE + static_cast<std::ptrdiff_t>(head.size()));
    impl_->enqueue(std::move(out));
}

void Socket::post(std::function<void()> work) {
    {
        std::scoped_lock lock(impl_->mutex);
        impl_->posted.push_back(std::move(work));
    }
    if (impl_->context) lws_cancel_service(impl_->context);
}

void Socket::close(int code, const std::string& why) {
    impl_->closeCode = code;
    impl_->closeWhy = why.substr(0, 120);  // a close frame holds 125 bytes
    impl_->closeAsked = true;
    if (impl_->wsi) lws_callback_on_writable(impl_->wsi);
}

void Socket::reconnectIn(int ms) {
    impl_->again = ms >= 0;
    impl_->nextAttempt = Clock::now() + std::chrono::milliseconds(ms);
}

void Socket::settled() {
    impl_->backoff.reset();
}

int Socket::waitMs() const {
    if (!impl_->again) return -1;
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(impl_->nextAttempt - Clock::now());
    return std::max(0, static_cast<int>(wait.count()));
}

void Socket::Impl::enqueue(Outgoing message) {
    {
        std::scoped_lock lock(mutex);
        if (!open) return;
        queue.push_back(std::move(message));
    }
    lws_cancel_service(context);
}

void Socket::Impl::runPosted() {
    std::vector<std::function<void()>> work;
    {
        std::scoped_lock lock(mutex);
        work.swap(posted);
    }
    for (auto& item : work) item();
}

void Socket::Impl::run() {
    onTick(&tick.list);
    while (!stop) {
        if (!wsi && !attempting && again && Clock::now() >= nextAttempt) attempt();
        lws_service(context, 0);
    }

    // Say goodbye, but wait for no one long.
    closeAsked = true;
    closeCode = LWS_CLOSE_STATUS_NORMAL;
    const auto last = Clock::now() + kFarewell;
    while (wsi && Clock::now() < last) {
        lws_callback_on_writable(wsi);
        lws_service(context, 0);
    }
    lws_sul_cancel(&tick.list);
}

void Socket::Impl::onTick(lws_sorted_usec_list_t* list) {
    auto* self = reinterpret_cast<Tick*>(list)->owner;
    lws_sul_schedule(self->context, 0, list, onTick, kTickUs);
    if (self->handlers.tick) self->handlers.tick();
}

void Socket::Impl::attempt() {
    const std::string host = address.host + ":" + std::to_string(address.port);
    lws_client_connect_info info{};
    info.context = context;
    info.address = address.host.c_str();
    info.port = address.port;
    info.path = address.path.c_str();
    info.host = host.c_str();
    info.protocol = protocols()[0].name;
    info.local_protocol_name = protocols()[0].name;
    info.ietf_version_or_minus_one = -1;
    info.alpn = "http/1.1";
    if (address.tls) info.ssl_connection = LCCSCF_USE_SSL;
    attempting = true;
    closeAsked = false;
    certificate.clear();
    if (!lws_client_connect_via_info(&info) && attempting) ended("cannot connect");
}

// A connection, or the attempt at one, is over: say so once and choose when to try again.
void Socket::Impl::ended(const std::string& why) {
    wsi = nullptr;
    attempting = false;
    received.clear();
    {
        std::scoped_lock lock(mutex);
        open = false;
        queue.clear();
    }
    std::uniform_real_distribution<double> share;
    nextAttempt = Clock::now() + std::chrono::milliseconds(backoff.next(share(random)));
    const int code = std::exchange(peerCode, 0);
    if (stop || !handlers.closed) return;
    if (!certificate.empty())
        handlers.closed(kBadCertificate, "the certificate of " + address.host + " is not trusted: " + certificate);
    else if (address.tls && why.starts_with("connect SSL"))
        handlers.closed(code, "what answers does not speak TLS; try http or ws");
    else
        handlers.closed(code, why);
}

int Socket::Impl::receive(const char* bytes, std::size_t length) {
    if (lws_is_first_fragment(wsi)) received.clear();
    const bool binary = lws_frame_is_binary(wsi);
    const std::size_t limit = binary ? kMaxBinary : kMaxText;
    if (received.size() + length + lws_remaining_packet_payload(wsi) > limit) {
        closeWhy = "a message is larger than any this protocol has";
        lws_close_reason(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, nullptr, 0);
        return -1;
    }
    received.insert(received.end(), bytes, bytes + length);
    if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi) > 0) return 0;
    if (binary) {
        if (handlers.binary) handlers.binary(received);
    } else if (handlers.text) {
        handlers.text({reinterpret_cast<const char*>(received.data()), received.size()});
    }
    received.clear();
    return 0;
}

int Socket::Impl::write() {
    if (closeAsked) {
        lws_close_reason(wsi, static_cast<lws_close_status>(closeCode),
                         reinterpret_cast<unsigned char*>(closeWhy.data()), closeWhy.size());
        return -1;
    }
    Outgoing message{};
    bool more = false;
    {
        std::scoped_lock lock(mutex);
        if (queue.empty()) return 0;
        message = std::move(queue.front());
        queue.pop_front();
        more = !queue.empty();
    }
    const std::size_t length = message.bytes.size() - LWS_PRE;
    if (lws_write(wsi, message.bytes.data() + LWS_PRE, length, message.binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT) < 0)
        return -1;
    if (more) lws_callback_on_writable(wsi);
    return 0;
}

int Socket::Impl::callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length) {
    auto* self = static_cast<Impl*>(lws_context_user(lws_get_context(wsi)));
    const auto* bytes = static_cast<const char*>(in);
    switch (reason) {
        case LWS_CALLBACK_CLIENT_ESTABLISHED:
            self->wsi = wsi;
            self->attempting = false;
            {
                std::scoped_lock lock(self->mutex);
                self->open = true;
            }
            if (self->handlers.opened) self->handlers.opened();
            return 0;
        case LWS_CALLBACK_OPENSSL_PERFORM_SERVER_CERT_VERIFICATION:
            // `length`: whether OpenSSL found this link of the chain good. Nothing is overruled, but said why.
            if (length == 0) self->certificate = certificateProblem(X509_STORE_CTX_get_error(static_cast<X509_STORE_CTX*>(user)));
            return length == 0;
        case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
            self->ended(bytes && length ? std::string(bytes, length) : "cannot connect");
            return 0;
        case LWS_CALLBACK_CLIENT_RECEIVE:
            return self->receive(bytes, length);
        case LWS_CALLBACK_CLIENT_WRITEABLE:
            return self->write();
        case LWS_CALLBACK_WS_PEER_INITIATED_CLOSE:
            if (length >= 2)
                self->peerCode = static_cast<std::uint8_t>(bytes[0]) << 8 | static_cast<std::uint8_t>(bytes[1]);
            if (length > 2) self->closeWhy.assign(bytes + 2, length - 2);
            return 0;
        case LWS_CALLBACK_CLIENT_CLOSED:
            self->ended(self->closeWhy.empty() ? "the server closed the connection" : self->closeWhy);
            self->closeWhy.clear();
            return 0;
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED: {
            self->runPosted();
            std::scoped_lock lock(self->mutex);
            if (self->wsi && !self->queue.empty()) lws_callback_on_writable(self->wsi);
            return 0;
        }
        default:
            return 0;
    }
}

}  // namespace caustream::connection
