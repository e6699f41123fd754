// A session with a server: keeps the state document, connects again by itself and says it all once more when it does.
// The network and the decoding have a thread of their own; nothing here waits for either.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "client/connection/address.h"
#include "client/connection/events.h"
#include "client/connection/upload.h"

namespace caustream::connection {

// The clock of every time on the wire that is ours: monotonic, microseconds.
std::uint64_t nowUs();

struct Options {
    Address address;
    std::string clientName;
    std::optional<std::string> token;
    std::string caFile;  // PEM, instead of the system's authorities; only with TLS
    std::string follow;  // another session's view id, whose scene is shown with a camera of our own; empty: a scene of our own
    std::uint32_t maxInflight = 2;  // frames under way, 1..8
    bool strict = false;            // a field that the protocol does not know is an error
    bool keepEncoded = false;       // fill Frame::encoded
    std::function<void()> wake;     // something is new; called on the network thread, must not block
};

// Every function may be called from any one thread.
class Connection {
 public:
    explicit Connection(Options options);
    ~Connection();

    // Merges a patch (RFC 7396) into the document and sends it. The error: what the protocol has against it; then
    // nothing changed. Otherwise the id that the server's Ok or ErrorMessage will carry; 0 while there is no
    // connection: the next server is told.
    tl::expected<std::uint32_t, protocol::DecodeError> update(const protocol::Json& patch);
    // The same for what a hand moves (`camera`, `lights`): no reply, the newest wins. The error as above, else its
    // number, which comes back in the header of the first frame that shows it.
    tl::expected<std::uint32_t, protocol::DecodeError> input(const protocol::Json& patch);
    // What was asked for so far, without what the server refused.
    protocol::Json document() const;

    // Sends a GLB, then shows it; keeps it, for a server that lacks it. UploadProgress events tell how far it is; an ErrorMessage or StateMessage ends it.
    void showFile(std::vector<std::uint8_t> glb);

    void startStream(bool stats);
    void pauseStream();
    // Asks for one frame, with `converge` as it is drawn while nothing moves; it comes through takeRequested(). 0 while
    // there is no connection.
    std::uint32_t requestFrame(bool still, bool converge = false);
    // Whether the server writes what this session does to a file; Ok::recording names it. 0 while there is no connection.
    std::uint32_t record(bool on);
    // After a Disconnected that does not retry: tries again all the same.
    void reconnect();
    // The frame is on the screen (or wherever it was to go): the server may send another.
    void acknowledge(const Frame& frame, std::uint32_t paintUs);

    std::optional<Frame> takeFrame();      // the stream's newest, if there is one that was not taken
    std::optional<Frame> takeRequested();  // the newest that was asked for by requestFrame
    std::vector<Event> takeEvents();
    // Until something is new, at most this long.
    void wait(std::chrono::milliseconds longest);

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace caustream::connection
