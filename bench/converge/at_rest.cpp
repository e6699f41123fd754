#include "bench/converge/at_rest.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "bench/statistics.h"

namespace caustream::bench {

namespace {

constexpr double kRarer = 1.2;           // frames between two looks at the map grow with their number
constexpr int kWarmUp = 3;

// Of a map in RGB on the window.
std::vector<float> luminanceOf(std::vector<float> xyz, const Window& window, const scene::Light& light) {
    rgbToXyz(xyz, light.spectrum);
    const std::size_t area = window.weights().size();
    return {xyz.begin() + static_cast<std::ptrdiff_t>(area), xyz.begin() + static_cast<std::ptrdiff_t>(2 * area)};
}

double gap(const render::EnergyLedger& l) {
    const double gone = l.deposited + l.absorbed + l.reflected + l.totalReflection + l.rejected + l.leftMap + l.noReceiver + l.cut;
    return l.onCasters > 0.0 ? std::abs(l.onCasters - gone) / l.onCasters : gone;
}

}  // namespace

AtRest comeToRest(Renderer& renderer, const Subject& subject, const Configuration& configuration, const RestSettings& settings) {
    render::Pipeline& pipeline = renderer.pipeline(configuration, subject.fingerprint);
    render::Request request = settings.pictures ? pictureRequest(subject.scene, configuration, settings.pictureSize) : mapRequest(subject.scene, configuration);
    request.exposureEv.reset();
    request.scene = std::make_shared<const scene::Scene>(withMovedLight(subject.scene, 1));
    for (int i = 0; i < kWarmUp; ++i) request.converge = i > 0, pipeline.run(request);
    request.scene = std::make_shared<const scene::Scene>(subject.scene);
    render::Request look = mapRequest(subject.scene, configuration);
    look.scene = request.scene;

    AtRest rest;
    Spent spent;
    std::map<std::string, std::vector<double>> stages;
    double next = 1.0;
    for (int frames = 1;; ++frames) {
        request.converge = frames > 1;
        const Clock clock;
        const render::FrameStats stats = pipeline.run(request).stats;
        spent += clock.spent();
        rest.worstLedgerGap = std::max(rest.worstLedgerGap, gap(stats.ledger));
        rest.converged = !stats.convergence || stats.convergence->converged;
        const std::uint64_t photons = stats.convergence ? stats.convergence->photons : stats.photons;
        const bool last = rest.converged || photons >= settings.mostPhotons || frames >= settings.mostFrames || spent.seconds > settings.mostSeconds;
        rest.ledger = stats.ledger;
        for (const render::StageTime& stage : stats.stages) {
            if (frames > 1) stages[stage.pass].push_back(stage.ms);
        }
        if (frames < next && !last) continue;
        next = std::max(next + 1.0, kRarer * next);
        const render::Frame map = pipeline.run(look);
        if (rest.points.empty()) rest.window = subject.plane ? *subject.plane : Window::ofView(subject.light(), glm::dmat4(map.lightMatrix), settings.cells);
        rest.points.push_back({.frames = frames, .spent = spent, .photons = photons, .estimate = stats.convergence ? stats.convergence->error : 0.0,
                               .luminance = luminanceOf(mapOnWindow(pipeline, look, map, rest.window), rest.window, subject.light())});
        if (!last) continue;
        for (const auto& [pass, ms] : stages) rest.stages.push_back({pass, median(ms)});
        std::ranges::sort(rest.stages, std::greater{}, &render::StageTime::ms);
        return rest;
    }
}

double relativeL1(const std::vector<float>& map, const float* reference) {
    double difference = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) difference += std::abs(double(map[i]) - double(reference[i])), sum += reference[i];
    return sum > 0.0 ? difference / sum : 0.0;
}

}  // namespace caustream::bench
