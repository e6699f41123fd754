#include "client/shot/replay.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "client/connection/image_file.h"
#include "client/shot/configure.h"
#include "client/shot/line_drawing.h"
#include "client/shot/line_files.h"
#include "client/shot/log_file.h"
#include "client/shot/progress_bar.h"
#include "client/shot/stop_signal.h"

namespace caustream::shot {
namespace {

namespace fs = std::filesystem;
using protocol::Json;
using Clock = std::chrono::steady_clock;

constexpr const char* kNoHash = "0000000000000000";  // of a frame that did not count its map's

class Replay {
 public:
    Replay(const Options& options, Log log)
        : options_(options),
          log_(std::move(log)),
          out_(options.out),
          stop_(stopSignal()),
          session_(connectionTo(options), std::chrono::seconds(options.timeoutS), &stop_) {}
    int run();

 private:
    Session::Done begin();
    Session::Done play(const LogStep& step);
    Session::Done change(const LogStep& step);
    Session::Done picture(const LogStep& step, bool still, bool converge);
    Json lossless(Json document) const;
    int conclude(const Session::Done& done);

    const Options& options_;
    Log log_;
    fs::path out_;
    const std::atomic<bool>& stop_;
    Session session_;
    Json document_;              // as the log has it
    int changes_ = 0, pictures_ = 0, same_ = 0, different_ = 0;
    Clock::time_point start_, nextInput_;
    std::string report_;
};

// Whatever the viewer of then was sent, here every sample counts.
Json Replay::lossless(Json document) const {
    document["stream"]["encoding"] = "raw";
    document["stream"].erase("quality");
    return document;
}

Session::Done Replay::begin() {
    if (auto connected = session_.connect(); !connected) return connected;
    if (isFile(options_.scene)) {
        auto bytes = readFile(options_.scene);
        if (!bytes) return tl::make_unexpected(bytes.error());
        if (auto shown = session_.showFile(std::move(*bytes)); !shown) return shown;
    }
    document_ = log_.state;
    Json patch = patchBetween(session_.connection().document(), lossless(document_));
    // A document that names no scene shows the server's default.
    if (document_.contains("scene")) patch["scene"] = document_["scene"];
    return session_.update(patch);
}

Session::Done Replay::change(const LogStep& step) {
    document_.merge_patch(step.patch);
    if (step.kind == LogStep::Kind::Update) return session_.update(patchBetween(session_.connection().document(), lossless(document_)));
    // Half of what a server lets through in a second.
    std::this_thread::sleep_until(nextInput_);
    nextInput_ = Clock::now() + std::chrono::microseconds(2'000'000 / std::max(1u, session_.welcome().limits.messagesPerS));
    const auto sent = session_.connection().input(step.patch);
    if (!sent) return tl::make_unexpected(sent.error().field + ": " + sent.error().message);
    return {};
}

Session::Done Replay::picture(const LogStep& step, bool still, bool converge) {
    const auto shown = requestShown(session_, converge, still);
    if (!shown) return tl::make_unexpected(shown.error());
    ++pictures_;
    const bool bytes = shown->frame.image.sample == protocol::Sample::U8;
    char name[32];
    std::snprintf(name, sizeof name, "%06d.%s", step.number, bytes ? "png" : "npy");
    const auto written = bytes ? connection::writePng(out_ / name, shown->frame.image) : connection::writeNpy(out_ / name, shown->frame.image);
    if (!written) return tl::make_unexpected(written.error());

    const bool request = step.kind == LogStep::Kind::Request;
    Json line = {{"line", step.number},
                 {"op", request ? "frame.request" : step.kind == LogStep::Kind::Input ? "input" : "update"},
                 {"file", name},
                 {"map_hash", shown->frame.mapHash}};
    if (shown->stats) line["photons"] = shown->stats->photons;
    if (step.mapHash) {
        // Light that was traced for longer has more photons, and cannot be the same.
        const bool comparable = *step.mapHash != kNoHash && shown->frame.mapHash != kNoHash && shown->stats && step.photons == shown->stats->photons;
        const bool same = *step.mapHash == shown->frame.mapHash;
        line["then"] = {{"map_hash", *step.mapHash}, {"photons", *step.photons}};
        line["same"] = comparable ? Json(same) : Json();
        if (comparable) ++(same ? same_ : different_);
        if (comparable && !same)
            std::fprintf(stderr, "caustream-shot: %s:%d: the map is %s, the log has %s\n", options_.replay.c_str(), step.number,
                         shown->frame.mapHash.c_str(), step.mapHash->c_str());
    }
    report_ += line.dump() + "\n";
    return {};
}

Session::Done Replay::play(const LogStep& step) {
    if (options_.realTime) std::this_thread::sleep_until(start_ + std::chrono::microseconds(step.atUs));
    if (step.kind == LogStep::Kind::Request) return picture(step, step.still, step.converge);
    if (auto changed = change(step); !changed) return changed;
    return ++changes_ % options_.every == 0 ? picture(step, true, false) : Session::Done{};
}

int Replay::conclude(const Session::Done& done) {
    if (auto written = writeWhole(out_ / "report.jsonl", report_); !written) {
        std::fprintf(stderr, "caustream-shot: %s\n", written.error().c_str());
        return 1;
    }
    std::printf("%s: %d changes played, %d pictures; of the maps that the log noted %d are the same, %d are not; %s lists them\n", out_.c_str(),
                changes_, pictures_, same_, different_, (out_ / "report.jsonl").c_str());
    if (!done) return stop_ ? 130 : 1;
    return different_ > 0 ? 2 : 0;
}

int Replay::run() {
    std::error_code failed;
    fs::create_directories(out_, failed);
    Session::Done done;
    if (failed) done = tl::make_unexpected("cannot make the folder " + options_.out + ": " + failed.message());
    if (done) done = begin();
    if (!done) {
        std::fprintf(stderr, "caustream-shot: %s\n", done.error().c_str());
        return 1;
    }
    ProgressBar bar;
    start_ = nextInput_ = Clock::now();
    for (std::size_t i = 0; i < log_.steps.size() && done; ++i) {
        done = play(log_.steps[i]);
        bar.show(static_cast<double>(i + 1) / static_cast<double>(log_.steps.size()), std::to_string(pictures_) + " pictures");
        if (done) continue;
        bar.clear();
        std::fprintf(stderr, "caustream-shot: %s:%d: %s\n", options_.replay.c_str(), log_.steps[i].number, done.error().c_str());
    }
    bar.clear();
    return conclude(done);
}

}  // namespace

int runReplay(const Options& options) {
    std::ifstream in(options.replay);
    auto log = readLog(in);
    if (!log) {
        std::fprintf(stderr, "caustream-shot: %s, %s\n", options.replay.c_str(), log.error().c_str());
        return 1;
    }
    return Replay(options, std::move(*log)).run();
}

}  // namespace caustream::shot
