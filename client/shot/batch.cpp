#include "client/shot/batch.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "client/shot/batch_plan.h"
#include "client/shot/configure.h"
#include "client/shot/line_drawing.h"
#include "client/shot/line_files.h"
#include "client/shot/progress_bar.h"
#include "client/shot/render_turns.h"
#include "client/shot/stop_signal.h"

namespace caustream::shot {
namespace {

namespace fs = std::filesystem;
using protocol::Json;
using Clock = std::chrono::steady_clock;

constexpr int kReconnects = 20;     // a second apart, until a server that is started again is there
constexpr int kTriesOfALine = 2;    // where the connection was lost at it: once may be chance
constexpr auto kTell = std::chrono::milliseconds(200);

struct Work {
    const LineJob* job;
    std::size_t order;  // among those that converge
};

class Batch {
 public:
    explicit Batch(const Options& options) : options_(options) {}
    int run();

 private:
    using Outcome = tl::expected<Json, Failure>;

    std::unique_ptr<Session> connect(Failure& why);
    tl::expected<BatchPlan, Failure> plan(Session& session);
    void queue(const BatchPlan& plan);
    void work(std::unique_ptr<Session> session, int worker);
    bool draw(std::unique_ptr<Session>& session, const Work& work, Failure& lost);
    Outcome attempt(Session& session, const Work& work);
    void tell();
    int conclude(const BatchPlan& plan);

    const Options& options_;
    fs::path out_;
    std::atomic<bool> stop_{false};
    std::unique_ptr<RenderTurns> turns_;

    std::mutex mutex_;
    std::condition_variable news_;
    std::deque<Work> waiting_;                   // guarded by mutex_, like all below
    std::map<int, Json> done_;                   // NAME.json by line
    std::map<int, std::string> failed_;
    std::deque<std::string> said_;               // for standard error
    std::string converging_;
    std::size_t total_ = 0, there_ = 0, wrong_ = 0, workers_ = 0;   // total_: to be drawn
};

std::unique_ptr<Session> Batch::connect(Failure& why) {
    auto session = std::make_unique<Session>(connectionTo(options_), std::chrono::seconds(options_.timeoutS), &stop_);
    if (auto connected = session->connect(); !connected) {
        why = connected.error();
        return nullptr;
    }
    return session;
}

// What the lines' patches go on is what one shot with these options would show.
tl::expected<BatchPlan, Failure> Batch::plan(Session& session) {
    if (auto configured = configure(session, options_); !configured) return tl::make_unexpected(configured.error());
    PlanOptions planning{.start = session.connection().document(),
                         .targets = options_.targets,
                         .formats = options_.formats,
                         .converge = options_.converge,
                         .passes = session.welcome().passes,
                         .folder = fs::path(options_.batch).parent_path()};
    planning.start["scene"] = isFile(options_.scene) ? Json{"file", fs::absolute(options_.scene)} : session.state()["scene"];
    const Json stream = planning.start.value("stream", Json::object());
    planning.start["stream"] = {{"width", stream.value("width", options_.width)}, {"height", stream.value("height", options_.height)}};
    std::ifstream in(options_.batch);
    if (!in) return tl::make_unexpected("cannot read " + options_.batch + "; --batch takes a file with a JSON object in each line");
    return planBatch(in, planning);
}

void Batch::queue(const BatchPlan& plan) {
    for (const BadLine& bad : plan.bad) failed_[bad.number] = bad.error.text();
    wrong_ = failed_.size();
    std::vector<const LineJob*> converging;
    std::size_t stills = 0;
    for (const LineJob& job : plan.jobs) {
        if (Json there = options_.force ? Json() : completeLine(out_, job); !there.is_null()) {
            done_[job.number] = std::move(there);
        } else if (job.converge) {
            converging.push_back(&job);
        } else {
            waiting_.push_back({&job, 0});
            ++stills;
        }
    }
    there_ = done_.size();
    for (const LineJob* job : converging) waiting_.push_back({job, waiting_.size() - stills});
    total_ = waiting_.size();
    turns_ = std::make_unique<RenderTurns>(stills, stop_);
}

Batch::Outcome Batch::attempt(Session& session, const Work& work) {
    const LineJob& job = *work.job;
    job.converge ? turns_->enterConverging(work.order) : turns_->enterStill();
    const auto start = Clock::now();
    auto drawn = drawLine(session, job, options_.formats, [&](const protocol::Convergence& reached) {
        char text[80];
        std::snprintf(text, sizeof text, "; line %d converges: %.0f%%", job.number, 100.0 * reached.progress);
        const std::scoped_lock lock(mutex_);
        converging_ = text;
    });
    job.converge ? turns_->leaveConverging() : turns_->leaveStill();
    if (!drawn) return tl::make_unexpected(drawn.error());
    Json about = aboutLine(session);
    about["timing"]["took_ms"] = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    auto written = writeLine(out_, job, *drawn, options_.formats, about);
    if (!written) return tl::make_unexpected(written.error());
    return std::move(*written);
}

// False: there is no server any more, or it is time to stop; the line is as if it had not been begun.
bool Batch::draw(std::unique_ptr<Session>& session, const Work& work, Failure& lost) {
    for (int tries = 1;; ++tries) {
        auto outcome = attempt(*session, work);
        if (stop_ && !outcome) return false;
        if (!outcome && session->refusal()) outcome = tl::make_unexpected("patch." + *session->refusal());
        const bool connected = outcome.has_value() || session->recover();
        if (outcome.has_value() || connected || tries == kTriesOfALine) {
            const std::scoped_lock lock(mutex_);
            converging_.clear();
            if (outcome) {
                done_[work.job->number] = std::move(*outcome);
            } else {
                failed_[work.job->number] = outcome.error();
                said_.push_back(options_.batch + ":" + std::to_string(work.job->number) + ": " + outcome.error());
            }
        }
        if (connected) return true;
        lost = outcome.error();
        session.reset();
        for (int i = 0; i < kReconnects && !session && !stop_; ++i) {
            std::this_thread::sleep_for(std::chrono::seconds(1));
            session = connect(lost);
        }
        if (!session) return false;
        if (tries == kTriesOfALine) return true;
    }
}

void Batch::work(std::unique_ptr<Session> session, int worker) {
    Failure why;
    if (!session) session = connect(why);
    while (session && !stop_) {
        std::unique_lock lock(mutex_);
        // A viewer's pictures at rest are its own: lines that converge share one viewer's, however many there are.
        if (waiting_.empty() || (worker > 0 && waiting_.front().job->converge)) break;
        const Work work = waiting_.front();
        waiting_.pop_front();
        lock.unlock();
        if (!draw(session, work, why)) break;
        news_.notify_all();
    }
    const std::scoped_lock lock(mutex_);
    if (!why.empty() && !stop_ && !session) said_.push_back("connection " + std::to_string(worker + 1) + " of " + std::to_string(options_.connections) + " is gone: " + why);
    --workers_;
    news_.notify_all();
}

// Standard error and its bar, until no one works any more.
void Batch::tell() {
    ProgressBar bar;
    const auto start = Clock::now();
    const std::atomic<bool>& signalled = stopSignal();
    std::unique_lock lock(mutex_);
    for (;;) {
        for (; !said_.empty(); said_.pop_front()) {
            bar.clear();
            std::fprintf(stderr, "caustream-shot: %s\n", said_.front().c_str());
        }
        if (workers_ == 0) return;
        const std::size_t ended = done_.size() - there_ + failed_.size() - wrong_;
        char text[120] = "";
        if (ended > 0) {
            const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
            std::snprintf(text, sizeof text, ", about %.0f min left", seconds / static_cast<double>(ended) * static_cast<double>(total_ - std::min(ended, total_)) / 60.0);
        }
        bar.show(total_ > 0 ? static_cast<double>(ended) / static_cast<double>(total_) : 1.0,
                 std::to_string(ended) + " of " + std::to_string(total_) + " lines" + text + converging_);
        news_.wait_for(lock, kTell);
        if (signalled) stop_ = true;
    }
}

// The list of what is there, in the file's order: the same bytes for the same results.
int Batch::conclude(const BatchPlan& plan) {
    std::map<int, Json> lines;
    for (const LineJob& job : plan.jobs) lines[job.number] = {{"line", job.number}, {"name", job.name}, {"status", "pending"}, {"patch", job.patch}};
    for (const BadLine& bad : plan.bad) {
        lines[bad.number] = {{"line", bad.number}};
        if (!bad.name.empty()) lines[bad.number]["name"] = bad.name;
    }
    for (const auto& [number, error] : failed_) lines[number].update({{"status", "failed"}, {"error", error}});
    for (const auto& [number, json] : done_) {
        lines[number]["status"] = "done";
        for (const auto& [target, about] : json["targets"].items()) {
            lines[number]["files"][target] = about["files"];
            if (about["map_hash"] != "0000000000000000") lines[number]["map_hash"] = about["map_hash"];
        }
    }
    std::string text;
    for (const auto& [number, line] : lines) text += line.dump() + "\n";
    if (auto written = writeWhole(out_ / "index.jsonl", text); !written) {
        std::fprintf(stderr, "caustream-shot: %s\n", written.error().c_str());
        return 1;
    }
    const std::size_t pending = lines.size() - done_.size() - failed_.size();
    std::printf("%s: %zu lines: %zu drawn, %zu there already, %zu failed, %zu not begun; %s lists them\n", out_.c_str(), lines.size(),
                done_.size() - there_, there_, failed_.size(), pending, (out_ / "index.jsonl").c_str());
    if (pending == 0) return failed_.empty() ? 0 : 2;
    std::fprintf(stderr, "caustream-shot: stopped; the same command goes on from here\n");
    return stop_ ? 130 : 1;
}

int Batch::run() {
    const auto cannot = [](const Failure& why) {
        std::fprintf(stderr, "caustream-shot: %s\n", why.c_str());
        return 1;
    };
    out_ = options_.out;
    std::error_code failed;
    fs::create_directories(out_, failed);
    if (failed) return cannot("cannot make the folder " + options_.out + ": " + failed.message());
    removeUnfinished(out_);
    Failure why;
    auto first = connect(why);
    if (!first) return cannot(why);
    const auto planned = plan(*first);
    if (!planned) return cannot(planned.error());
    for (const BadLine& bad : planned->bad) said_.push_back(options_.batch + ":" + std::to_string(bad.number) + ": " + bad.error.text());
    queue(*planned);

    workers_ = std::min<std::size_t>(static_cast<std::size_t>(options_.connections), std::max<std::size_t>(total_, 1));
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < workers_; ++i)
        threads.emplace_back([this, i, session = i == 0 ? std::move(first) : nullptr]() mutable { work(std::move(session), static_cast<int>(i)); });
    tell();
    for (std::thread& thread : threads) thread.join();
    return conclude(*planned);
}

}  // namespace

int runBatch(const Options& options) { return Batch(options).run(); }

}  // namespace caustream::shot
