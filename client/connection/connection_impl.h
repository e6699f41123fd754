// The inside of a Connection: connection.cpp is its owner's side, connection_impl.cpp the network thread's.
#pragma once
#include <condition_variable>
#include <map>
#include <mutex>
#include <random>

#include "client/connection/connection.h"
#include "client/connection/decoder.h"
#include "client/connection/document.h"
#include "client/connection/kept_files.h"
#include "client/connection/mailbox.h"
#include "client/connection/socket.h"

namespace caustream::connection {

struct Connection::Impl {
    Options options;
    Mailbox<Frame> newest, requested;

    mutable std::mutex mutex;
    std::condition_variable news;
    bool isNew = false;  // guarded by mutex, like all down to the next blank line
    std::vector<Event> events;
    std::uint32_t lastId = 0, inputSeq = 0, recordId = 0;
    Document document;
    bool ready = false;  // welcomed, and the document is on its way
    bool streaming = false, statsWanted = false, recording = false;

    // The network thread only.
    Decoder decoder;
    std::string session;
    std::uint32_t rev = 0;  // the newest that the server told
    bool resuming = false;  // hello brought the document
    Json serverHas = Json::object();  // its document when it welcomed us
    Json theirs = Json::object();     // of a session that is followed: what it showed last
    KeptFiles kept;
    std::uint32_t helloId = 0;
    protocol::Limits limits;
    std::shared_ptr<const protocol::StreamInfo> info;
    std::map<std::uint32_t, std::string> expected;  // requested frames that were announced: number and map hash
    Bytes wantedFile;  // to be sent and shown; null: nothing is
    std::unique_ptr<Upload> upload;
    bool restoring = false;  // the upload is of a scene that the document already shows
    bool open = false, welcomed = false, helloRefused = false;
    std::string refusal;  // of the hello, a sentence
    std::uint64_t lastPingUs = 0, lastHeardUs = 0;
    int comeBack = -1;  // ms; what a goaway or a busy server asked for
    std::mt19937 random{std::random_device{}()};

    std::uint32_t nextId();
    double chance();                  // 0..1
    std::string assetShown() const;   // the SHA-256 of the scene in the document; empty: it is a built-in one
    void beginUpload(const Bytes& bytes, bool isRestored);
    void uploadEnded();
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

    std::unique_ptr<Socket> socket;  // set before its thread starts; the last member, so it ends first
};

}  // namespace caustream::connection
