// The inside of a Connection: connection.cpp is its owner's side, connection_impl.cpp the network thread's.
#pragma once
#include <condition_variable>
#include <map>
#include <mutex>

#include "client/connection/connection.h"
#include "client/connection/decoder.h"
#include "client/connection/mailbox.h"
#include "client/connection/socket.h"

namespace caustream::connection {

using protocol::Json;

struct Connection::Impl {
    Options options;
    Mailbox<Frame> newest, requested;

    mutable std::mutex mutex;
    std::condition_variable news;
    bool isNew = false;  // guarded by mutex, like all down to the next blank line
    std::vector<Event> events;
    std::uint32_t lastId = 0, inputSeq = 0;
    Json confirmed = Json::object();           // what the server took
    std::map<std::uint32_t, Json> unanswered;  // patches by the id of their update
    bool ready = false;                        // welcomed, and the document is on its way
    bool streaming = false, statsWanted = false;

    // The network thread only.
    Decoder decoder;
    std::string session;
    std::uint32_t helloId = 0;
    protocol::Limits limits;
    std::shared_ptr<const protocol::StreamInfo> info;
    std::map<std::uint32_t, std::string> expected;  // requested frames that were announced: number and map hash
    std::unique_ptr<Upload> upload;
    bool uploadShown = false;  // its scene was asked for, once
    bool open = false, welcomed = false;
    std::uint64_t lastPingUs = 0, lastHeardUs = 0;
    int comeBackMs = -1;  // what a goaway asked for

    std::uint32_t nextId();
    Json documentLocked() const;
    bool documentShows(const std::string& asset) const;
    void tell(Event event);
    void newsArrived();
    void hello();
    void onWelcome(const protocol::Welcome& welcome);
    void replay();
    void onText(std::string_view text);
    void onBinary(std::span<const std::uint8_t> message);
    void onClosed(int code, const std::string& why);
    void onTick();
    void onOk(const protocol::Ok& ok);
    void onError(const protocol::ErrorMessage& error);
    void afterUpload();

    std::unique_ptr<Socket> socket;  // set before its thread starts; the last member, so it ends first
};

}  // namespace caustream::connection
