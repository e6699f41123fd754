#include "bench/stability/examine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/stability/gpu_images.h"
#include "bench/stability/scene_parts.h"
#include "bench/stability/small_change.h"
#include "gl/debug.h"
#include "render/key_light.h"
#include "render/pipeline.h"

namespace caustream::stability {

namespace {

const std::vector<Mode> kModes = {{.name = "refined"},
                                  {.name = "continuous", .wavelengths = render::kContinuous},
                                  {.name = "traced", .transport = render::Mode::Traced},
                                  {.name = "traced-continuous", .transport = render::Mode::Traced, .wavelengths = render::kContinuous},
                                  {.name = "thesis", .transport = render::Mode::Thesis, .mustPass = false}};

constexpr int kMostConverging = 6;         // frames at rest; slow ones end there
constexpr double kConvergedError = 0.1;
constexpr int kLargestBandedMap = 512;   // bands are summed on the CPU: larger ones take seconds and show nothing new

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

class Examination {
   public:
    Examination(Renderer& renderer, Setup setup, const Mode& mode, int frames)
        : renderer_(renderer), setup_(std::move(setup)), mode_(mode), frames_(frames) {
        request_.scene = std::make_shared<const scene::Scene>(setup_.scene);
        request_.camera = setup_.scene.cameras.front();
        request_.transport = setup_.transport;
        request_.transport.mode = mode.transport;
        if (!setup_.ownWavelengths) request_.transport.wavelengths = mode.wavelengths;
        request_.width = request_.height = setup_.pictureSide;
        request_.sample = render::Sample::F32;
    }

    Outcome run() {
        startAnew();
        if (setup_.roundTrip) {
            checkRoundTrip();
        } else {
            checkStill();
            checkMoving();
            if (traced()) checkConverging();
            checkBands();
            checkSmallChange();
        }
        checkGl();
        return std::move(outcome_);
    }

   private:
    bool traced() const { return mode_.transport == render::Mode::Traced; }

    void startAnew() {
        pipeline_.reset();
        pipeline_ = std::make_unique<render::Pipeline>(*renderer_.context, renderer_.shaders);
    }

    void fail(const char* check, std::string what) {
        // A NaN in a layer is one in all that is made of it: the first of each kind tells.
        const auto same = [&](const Failure& failure) { return failure.check == check; };
        if (std::none_of(outcome_.failures.begin(), outcome_.failures.end(), same)) outcome_.failures.push_back({check, std::move(what)});
    }

    render::Frame frame(const render::Request& request, const char* what) {
        render::Frame frame = pipeline_->run(request);
        if (!allFinite(floats(frame))) fail("finite", std::string("values of ") + what);
        if (!std::isfinite(frame.stats.exposureEv)) fail("finite", std::string("the exposure of ") + what);
        for (int i = 0; i < 16; ++i) {
            if (!std::isfinite(frame.lightMatrix[i / 4][i % 4])) fail("finite", std::string("the map's matrix of ") + what);
        }
        const double gap = ledgerGap(frame.stats.ledger);
        if (!(gap <= kLedgerLimit)) fail("ledger", std::string(what) + " leaves " + number(gap) + " of the flux");
        outcome_.ledgerGap = std::max(outcome_.ledgerGap, gap);
        return frame;
    }

    std::vector<GpuImage> images(const char* what) {
        std::vector<GpuImage> images = readGpuImages();
        for (GpuImage& image : images) {
            if (image.notFinite > 0) fail("finite", std::to_string(image.notFinite) + " values of the image \"" + image.label + "\", " + what);
            image.name = 0;
        }
        return images;
    }

    // Twice from nothing: the same bits in every image.
    void checkStill() {
        render::Request request = request_;
        request.still = true;
        const render::Frame first = frame(request, "the still picture");
        const std::vector<GpuImage> firstImages = images("still");
        startAnew();
        const render::Frame second = frame(request, "the still picture");
        const std::vector<GpuImage> secondImages = images("still, again");
        if (first.mapHash != second.mapHash) fail("bits", "of the fixed-point map");
        for (std::size_t i = 0; i < std::min(firstImages.size(), secondImages.size()); ++i) {
            if (!(firstImages[i] == secondImages[i])) fail("bits", "of the image \"" + firstImages[i].label + "\"");
        }
        if (first.pixels != second.pixels || firstImages.size() != secondImages.size()) fail("bits", "of the picture");
        outcome_.photons = first.stats.photons, outcome_.ledger = first.stats.ledger, outcome_.warnings = first.stats.warnings;
        if (!mode_.mustPass) return;
        for (const Setup::Expectation& expect : {setup_.expect, traced() ? setup_.expectTraced : setup_.expectRefined}) {
            if (!expect) continue;
            if (std::string wrong = expect(first.stats.ledger); !wrong.empty()) fail("energy", std::move(wrong));
        }
    }

    void checkMoving() {
        frame(request_, "the moving picture");
        images("moving");
    }

    // Frames at rest until the map is as good as asked for, twice from nothing: more photons, no fewer, and the same bits in
    // the end. How many a frame adds is the machine's affair, where they end is not.
    void checkConverging() {
        render::Request request = request_;
        request.transport.targetError = kConvergedError;
        render::Frame first, second;
        for (render::Frame* last : {&first, &second}) {
            startAnew();
            request.converge = request.still = false;
            std::uint64_t photons = 0;
            bool more = true;
            for (int i = 0; more && i < kMostConverging; ++i) {
                *last = frame(request, "a picture at rest");
                request.converge = true;
                const auto& convergence = last->stats.convergence;
                more = convergence && !convergence->converged;
                if (!convergence) continue;
                if (!std::isfinite(convergence->error) || !(convergence->progress >= 0.0 && convergence->progress <= 1.0)) fail("finite", "how far it has converged");
                if (convergence->photons < photons) fail("converge", "loses photons");
                photons = convergence->photons;
            }
            images("at rest");
            request.still = true;
            *last = frame(request, "the still at rest");
        }
        const auto &one = first.stats.convergence, &other = second.stats.convergence;
        if (one.has_value() != other.has_value()) fail("converge", "once, and not again");
        if (!one || !other || !one->converged || !other->converged) return;
        if (one->photons != other->photons) fail("converge", "after " + std::to_string(one->photons) + " photons, then after " + std::to_string(other->photons));
        if (first.mapHash != second.mapHash) fail("bits", "of the map at rest");
    }

    void checkBands() {
        if (request_.transport.mapSize > kLargestBandedMap || mode_.transport == render::Mode::Thesis) return;
        render::Request request = request_;
        request.target = render::Target::Spectral;
        request.wavelengthBands = true;
        frame(request, "the map in bands");
    }

    MapImage map(const render::Request& request, const char* what) {
        const render::Frame shown = frame(request, what);
        if (request.countResiduals) outcome_.residuals = shown.stats.residuals;
        MapImage map{request.transport.mapSize, {}, shown.lightMatrix};
        const std::vector<float> rgb = floats(shown);
        for (const GpuImage& image : readGpuImages()) {
            if (image.depth || image.width != map.size || image.height != map.size) continue;
            std::vector<glm::vec4> texels = readTexels(image);
            bool same = true;
            for (std::size_t i = 0; same && i < texels.size(); ++i) same = texels[i].r == rgb[3 * i] && texels[i].g == rgb[3 * i + 1] && texels[i].b == rgb[3 * i + 2];
            if (same) map.texels = std::move(texels);
        }
        if (map.texels.empty()) fail("error", std::string("no image holds ") + what), map.size = 0;
        return map;
    }

    void checkSmallChange() {
        render::Request request = request_;
        request.target = render::Target::Spectral;
        const MapImage here = map(request, "the map");
        const auto moved = withLightMoved(setup_.scene, render::keyLight(setup_.scene));
        request.scene = std::make_shared<const scene::Scene>(moved ? *moved : setup_.scene);
        request.countResiduals = true;
        const MapImage there = map(request, "the map of the moved light");
        outcome_.change = changeBetween(here, there), outcome_.jumps = setup_.jumps;
        if (setup_.jumps.empty() && !(outcome_.change <= kChangeLimit)) fail("change", "of " + number(outcome_.change) + " of the map for a light " + number(kLightStep) + " aside");
    }

    // A light and a camera that go round their scene and come back: nothing of the way may be left.
    void checkRoundTrip() {
        render::Request request = request_;
        request.still = true;
        const render::Frame first = frame(request, "the first picture");
        const glm::vec3 middle = setup_.scene.geometry->casterBounds.centre();
        const auto turned = [&](const glm::vec3& position, const glm::mat4& turn) { return middle + glm::vec3(turn * glm::vec4(position - middle, 0)); };
        for (int i = 1; i < frames_; ++i) {
            const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(frames_);
            const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 1, 0));
            scene::Scene scene = setup_.scene;
            for (scene::Light& light : scene.lights) light.position = turned(light.position, turn), light.direction = glm::mat3(turn) * light.direction;
            render::Request between = request_;
            between.camera.eye = turned(request_.camera.eye, turn);
            between.scene = std::make_shared<const scene::Scene>(std::move(scene));
            frame(between, "a picture on the way");
        }
        const render::Frame last = frame(request, "the last picture");
        images("after the round");
        if (first.mapHash != last.mapHash) fail("bits", "of the map after " + std::to_string(frames_) + " frames");
        if (first.pixels != last.pixels) fail("bits", "of the picture after " + std::to_string(frames_) + " frames");
        outcome_.photons = first.stats.photons, outcome_.warnings = first.stats.warnings;
    }

    void checkGl() {
        for (const unsigned error : takeGlErrors()) fail("GL", "error " + std::to_string(error));
        for (const std::string& message : gl::takeDebugMessages()) fail("GL", message);
    }

    Renderer& renderer_;
    Setup setup_;
    const Mode& mode_;
    int frames_;
    render::Request request_;
    std::unique_ptr<render::Pipeline> pipeline_;
    Outcome outcome_;
};

}  // namespace

std::span<const Mode> modes() { return kModes; }

Outcome examine(Renderer& renderer, const Case& which, const Mode& mode, int frames) {
    const auto start = std::chrono::steady_clock::now();
    takeGlErrors(), gl::takeDebugMessages();
    Outcome outcome;
    try {
        outcome = Examination(renderer, which.make(), mode, frames).run();
    } catch (const std::exception& error) {
        outcome.failures.push_back({"error", error.what()});
    }
    outcome.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return outcome;
}

}  // namespace caustream::stability
