#include "bench/accuracy/study.h"

#include <algorithm>
#include <cmath>

#include "bench/accuracy/fingerprint.h"
#include "bench/progress.h"
#include "bench/statistics.h"

namespace caustream::bench {

using nlohmann::json;

Study::Study(Renderer& renderer, Journal& journal, StudySettings settings)
    : renderer_(renderer), journal_(journal), settings_(std::move(settings)), build_(buildFingerprint()) {}

Truth Study::truth(const Subject& subject) {
    Progress progress("reference of " + subject.name);
    return makeTruth(renderer_, subject, settings_.truth, [&](double share) { progress.at(share); });
}

json Study::key(const Job& job, const std::string& kind) const {
    json key = {{"kind", kind}, {"build", build_}, {"gpu", renderer_.context().renderer()}, {"scene", job.subject->name},
                {"scene_bytes", job.subject->fingerprint}, {"configuration", job.configuration.name()},
                {"picture", settings_.truth.pictureSize}};
    if (kind == "error") key["photons"] = settings_.truth.photons, key["cells"] = settings_.truth.cells;
    return key;
}

// One turn: a frame that brings the images back into the processor's caches (the first turn: that makes them), then those
// that count.
void Study::time(const Job& job) {
    constexpr int kPosesKept = 5;   // one more than the pipeline keeps: from then on images are used again
    render::Pipeline& pipeline = renderer_.pipeline(job.configuration, job.subject->fingerprint);
    render::Request request = pictureRequest(job.subject->scene, job.configuration, settings_.truth.pictureSize);
    const int warmUp = warm_.insert(job.subject->fingerprint + job.configuration.name()).second ? kPosesKept : 1;
    const auto nextFrame = [&] {
        request.scene = std::make_shared<const scene::Scene>(withMovedLight(job.subject->scene, ++moves_));
        return frameTime(pipeline.run(request), renderer_.context().software());
    };
    constexpr double kPatienceMs = 500.0;   // slow frames need fewer: what warming up saves is little of them
    double spent = 0.0;
    for (int i = 0; i < warmUp && spent < kPatienceMs; ++i) spent += nextFrame().whole;
    std::vector<double> ms, lightMs;
    spent = 0.0;
    for (int i = 0; i < settings_.frames && spent < kPatienceMs; ++i) {
        const FrameTime frame = nextFrame();
        ms.push_back(frame.whole), lightMs.push_back(frame.light);
        spent += frame.whole;
    }
    journal_.add(key(job, "time"), {{"ms", ms}, {"light_ms", lightMs}});
}

std::vector<Outcome> Study::run(const std::string& what, const std::vector<Job>& jobs) {
    {
        Progress progress(what + ": errors");
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            const Job& job = jobs[i];
            progress.at(static_cast<double>(i) / static_cast<double>(jobs.size()), job.configuration.name());
            const json wanted = key(job, "error");
            if (journal_.of(wanted).empty()) {
                journal_.add(wanted, measureError(renderer_, *job.subject, *job.truth, job.configuration, settings_.truth));
            }
        }
    }
    {
        Progress progress(what + ": times");
        const int turns = settings_.rounds * static_cast<int>(jobs.size());
        for (int turn = 0; turn < turns; ++turn) {
            const Job& job = jobs[static_cast<std::size_t>(turn) % jobs.size()];
            const int round = turn / static_cast<int>(jobs.size());
            progress.at(static_cast<double>(turn) / turns, job.configuration.name());
            if (static_cast<int>(journal_.of(key(job, "time")).size()) <= round) time(job);
        }
    }
    std::vector<Outcome> outcomes;
    for (const Job& job : jobs) {
        Outcome outcome{.configuration = job.configuration, .error = journal_.of(key(job, "error")).front().get<MapError>()};
        std::vector<double> ms, lightMs;
        for (const json& turn : journal_.of(key(job, "time"))) {
            for (const json& value : turn.at("ms")) ms.push_back(value);
            for (const json& value : turn.at("light_ms")) lightMs.push_back(value);
        }
        outcome.ms = median(ms), outcome.lightMs = median(lightMs);
        outcome.spreadMs = quantile(ms, 0.75) - quantile(ms, 0.25);
        outcomes.push_back(std::move(outcome));
    }
    renderer_.forget();
    warm_.clear();
    return outcomes;
}

std::uint32_t Study::photonsOf(const Subject& subject, const Configuration& configuration) {
    render::Pipeline& scratch = renderer_.pipeline({}, subject.fingerprint);
    return scratch.run(mapRequest(subject.scene, configuration)).stats.photons;
}

Configuration Study::withPhotons(const Subject& subject, Configuration configuration, std::uint32_t photons) {
    // The count goes with the square of the side, up to rounding: a few steps settle it.
    for (int step = 0; step < 4; ++step) {
        const double traced = std::max(1.0, static_cast<double>(photonsOf(subject, configuration)));
        const int grid = configuration.transport.photonGrid;
        const int wanted = std::clamp(static_cast<int>(std::lround(grid * std::sqrt(photons / traced))), 16, 4096);
        if (wanted == grid) break;
        configuration.transport.photonGrid = wanted;
    }
    return configuration;
}

}  // namespace caustream::bench
