#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>
#include <vector>

#include "bench/progress.h"
#include "bench/stream/glb_file.h"
#include "bench/stream/mutation.h"
#include "bench/stream/scenarios.h"
#include "bench/stream/server_child.h"
#include "bench/stream/watch.h"
#include "client/connection/connection.h"
#include "error.h"

namespace caustream::bench {
namespace {

using connection::nowUs;
using e2e::Message;
using e2e::RawClient;
using protocol::Json;

constexpr int kLeastFrames = 3;   // of the healthy viewer, while it is attacked
constexpr int kAttackers = 4;
constexpr double kTextsPerS = 250;                // each; more would only be closed with 4429
constexpr int kFileEvery = 40, kBinaryEvery = 8, kStrangerEvery = 25;   // of the things sent
constexpr int kReplyMs = 20'000;
constexpr std::uint64_t kMostUs = 20 * 60'000'000ull;

std::vector<std::string> filesOf(const std::string& folder) {
    std::vector<std::string> files;
    if (folder.empty()) return files;
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) paths.push_back(entry.path());
    }
    std::ranges::sort(paths);
    for (const auto& path : paths) {
        std::ifstream file(path, std::ios::binary);
        files.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>{});
    }
    return files;
}

// One hostile program: a connection for as long as the server lets it, then another.
class Attacker {
   public:
    Attacker(int port, std::uint32_t seed) : port_(port), dice_(seed), glb_(builtinGlb("prism")) {}

    // The `i`th thing of this attacker.
    void send(int i) {
        if (!client_) connect();
        if (i % kStrangerEvery == 0) return stranger();
        if (i % kFileEvery == 1) return file(damagedGlb(glb_, dice_));
        if (i % kBinaryEvery == 2) binary();
        else client_->text(i % 2 == 0 ? damagedText(pick(), dice_) : damagedValues(pick(), dice_));
        read(0);
    }

    // A file of the corpus may have been made for any of the decoders.
    void sendCorpus(const std::string& bytes) {
        if (!client_) connect();
        client_->text(bytes.substr(0, 60'000));
        if (!read(0)) connect();
        client_->send(0x2, bytes.substr(0, 1'000'000));
        if (!read(0)) connect();
        if (!bytes.empty()) file(bytes);
    }

    int errors() const { return errors_; }
    int accepted() const { return accepted_; }
    int closed() const { return closed_; }

   private:
    const std::string& pick() { return validMessages()[dice_.below(validMessages().size())]; }

    void connect() {
        client_ = std::make_unique<RawClient>(port_);
        client_->hello();
        client_->update(plainDocument(false, 32));
    }

    // What has come within `ms`; false, and no client any more, once the server has closed.
    bool read(int ms) {
        while (true) {
            const Message message = client_->next(ms);
            if (message.kind == Message::Kind::Silence) return true;
            if (message.kind == Message::Kind::Close) {
                ++closed_;
                client_.reset();
                return false;
            }
            if (message.kind == Message::Kind::Binary) {
                if (const auto header = protocol::decodeFrameHeader(message.bytes)) client_->ack(header->frameSeq);
            } else {
                const std::string op = Json::parse(message.text).value("op", "");
                errors_ += op == "error";
                accepted_ += op == "ok" || op == "pong";
            }
        }
    }

    // A message before any hello, on a connection of its own.
    void stranger() {
        RawClient client(port_);
        client.text(damagedText(pick(), dice_));
        client.send(0x2, damagedBytes(validChunk(1, 0, "abcdefgh"), dice_));
        closed_ += client.next(5).kind == Message::Kind::Close;
    }

    void binary() {
        client_->send(0x2, damagedBytes(validChunk(static_cast<std::uint32_t>(dice_.below(3)), dice_.below(2) * 8, "abcdefgh"), dice_));
    }

    // Uploaded whole, with its own hash; what the server takes is looked at, too.
    void file(const std::string& bytes) {
        try {
            const Json report = upload(*client_, bytes);
            errors_ += report.is_object() && report.value("op", "") == "error";
            if (!report.is_object() || report.value("op", "") != "ok") return;
            ++accepted_;
            Json patch = {{"scene", {"asset", sha256(bytes)}}};
            for (const char* ofTheOther : {"lights", "materials", "camera", "environment", "outside_index"}) patch[ofTheOther] = nullptr;
            if (client_->update(patch).value("op", "") != "ok") return;
            client_->json({{"op", "frame.request"}, {"id", 900'000}});
            read(20);
        } catch (const std::exception&) {   // the server closed over what was sent before
            ++closed_;
            client_.reset();
        }
    }

    int port_;
    Dice dice_;
    std::string glb_;
    std::unique_ptr<RawClient> client_;
    int errors_ = 0, accepted_ = 0, closed_ = 0;
};

// A viewer that asks for the same picture again and again: what the server draws for it must not change by a bit.
struct Healthy {
    std::atomic<int> frames = 0;   // the attackers go on until there are a few
    int different = 0;
    std::string failed;
};

void watchHealthy(int port, const std::atomic<bool>& over, Healthy& outcome) {
    try {
        RawClient client(port);
        client.hello();
        Json document = plainDocument(false, 96);
        document["stream"].update({{"encoding", "png"}});
        client.update(document);
        const std::vector<std::uint8_t> first = client.requestFrame(true).payload;
        const std::string firstHash = client.lastReply.at("map_hash");
        while (!over) {
            const e2e::Picture picture = client.requestFrame(true);
            client.ack(picture.header.frameSeq);
            ++outcome.frames;
            outcome.different += picture.payload != first || client.lastReply.at("map_hash") != firstHash;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
    } catch (const std::exception& problem) {
        outcome.failed = problem.what();
    }
}

}  // namespace

Report malformed(const ScenarioOptions& options) {
    const ServerChild server(options.server, {"--gpu", options.gpu});
    const std::vector<std::string> corpus = filesOf(options.corpus);
    std::atomic<bool> over = false;
    Healthy outcome;
    std::thread healthy([&] { watchHealthy(server.port(), over, outcome); });
    while (outcome.frames == 0 && outcome.failed.empty() && server.alive()) std::this_thread::sleep_for(std::chrono::milliseconds(20));

    Progress progress("malformed");
    std::atomic<int> sent = 0, errors = 0, accepted = 0, closed = 0;
    std::vector<std::string> failed(kAttackers);
    std::vector<std::thread> threads;
    const std::uint64_t start = nowUs();
    for (int a = 0; a < kAttackers; ++a) {
        threads.emplace_back([&, a] {
            Attacker attacker(server.port(), 20261128u + static_cast<std::uint32_t>(a));
            const int own = (options.count + kAttackers - 1 - a) / kAttackers;
            try {
                for (std::size_t i = static_cast<std::size_t>(a); i < corpus.size(); i += kAttackers) attacker.sendCorpus(corpus[i]);
                const auto watched = [&] { return outcome.frames >= kLeastFrames || !outcome.failed.empty(); };
                for (int i = 0; (i < own || !watched()) && nowUs() - start < kMostUs; ++i, ++sent) {
                    attacker.send(i);
                    if (a == 0) progress.at(std::min(1.0, static_cast<double>(i) / own));
                    const auto due = start + static_cast<std::uint64_t>(1e6 * i / kTextsPerS);
                    if (const std::uint64_t now = nowUs(); now < due) std::this_thread::sleep_for(std::chrono::microseconds(due - now));
                }
            } catch (const std::exception& problem) {
                failed[static_cast<std::size_t>(a)] = problem.what();
            }
            errors += attacker.errors(), accepted += attacker.accepted(), closed += attacker.closed();
        });
    }
    for (std::thread& thread : threads) thread.join();
    over = true;
    healthy.join();

    Report report("malformed");
    report.note(std::to_string(sent) + " damaged messages and files and " + std::to_string(corpus.size()) + " of the corpus, by four programs at once");
    for (const std::string& problem : failed) {
        if (!problem.empty()) report.note("an attacker stopped: " + problem);
    }
    if (!outcome.failed.empty()) report.note("the healthy viewer: " + outcome.failed);
    const bool answers = server.alive() && e2e::httpGet(server.port(), "/livez").starts_with("HTTP/1.1 200");
    report.atLeast("sent", sent, options.count, "");
    report.atMost("server crashes", answers ? 0 : 1, 0, "");
    report.atMost("healthy viewer: connections lost", outcome.failed.empty() ? 0 : 1, 0, "");
    report.atLeast("healthy viewer: frames", outcome.frames, kLeastFrames, "");
    report.atMost("healthy viewer: frames with another bit", outcome.different, 0, "");
    report.shown("answered with an error", errors, "");
    report.shown("taken, as the damage left them valid", accepted, "");
    report.shown("connections closed by the server", closed, "");
    return report;
}

}  // namespace caustream::bench
