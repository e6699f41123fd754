#include "bench/converge/first_frames.h"

#include <array>

#include "bench/accuracy/clock.h"
#include "bench/statistics.h"

namespace caustream::bench {

namespace {

constexpr int kWarmUp = 6;   // more than a pipeline keeps light poses: from then on images are used again

}  // namespace

std::vector<FirstFrame> firstFrames(Renderer& renderer, const Subject& subject, int pictureSize, int turns) {
    constexpr std::array kModes = {"refined", "traced", "auto"};
    std::array<std::vector<double>, kModes.size()> ms, cpuMs, ratios;
    std::vector<FirstFrame> result;
    for (const char* mode : kModes) result.push_back({.mode = mode});
    for (int turn = -kWarmUp; turn < turns; ++turn) {
        for (std::size_t i = 0; i < kModes.size(); ++i) {
            Configuration configuration;
            configuration.transport.mode = std::array{render::Mode::Refined, render::Mode::Traced, render::Mode::Auto}[i];
            render::Pipeline& pipeline = renderer.pipeline(configuration, subject.fingerprint);
            render::Request request = pictureRequest(subject.scene, configuration, pictureSize);
            request.exposureEv.reset();
            request.scene = std::make_shared<const scene::Scene>(withMovedLight(subject.scene, turn + kWarmUp + 1));
            const Clock clock;
            const render::Frame frame = pipeline.run(request);
            const Spent spent = clock.spent();
            if (turn < 0) continue;
            ms[i].push_back(1e3 * spent.seconds), cpuMs[i].push_back(1e3 * spent.cpuSeconds);
            ratios[i].push_back(ms[i].back() / ms[0].back());
            result[i].photons = frame.stats.photons;
        }
    }
    for (std::size_t i = 0; i < kModes.size(); ++i) {
        result[i].ms = median(ms[i]), result[i].spreadMs = quantile(ms[i], 0.75) - quantile(ms[i], 0.25);
        result[i].cpuMs = median(cpuMs[i]), result[i].ratio = median(ratios[i]);
    }
    return result;
}

PhotonTime photonTime(Renderer& renderer, const Subject& subject, int frames) {
    constexpr int kGrid = 115;   // three quarters of a gem's view are gem
    Configuration configuration;
    configuration.transport.mode = render::Mode::Traced;
    configuration.transport.wavelengths = 7;
    configuration.transport.bounces = 8;
    configuration.transport.photonGrid = kGrid;
    configuration.transport.forceDispersive = true;
    render::Pipeline& pipeline = renderer.pipeline(configuration, subject.fingerprint);
    std::vector<double> ms;
    PhotonTime time;
    for (int i = -kWarmUp; i < frames; ++i) {
        render::Request request = mapRequest(subject.scene, configuration);
        request.scene = std::make_shared<const scene::Scene>(withMovedLight(subject.scene, i + kWarmUp + 1));
        const render::Frame frame = pipeline.run(request);
        for (const render::StageTime& stage : frame.stats.stages) {
            if (i >= 0 && stage.pass == "photon_paths") ms.push_back(stage.ms);
        }
        time.photons = frame.stats.photons;
    }
    time.ms = median(ms);
    return time;
}

}  // namespace caustream::bench
