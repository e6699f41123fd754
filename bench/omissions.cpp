// What leaving out saves: each omission's scene with it and without, frame by frame in turn.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>

#include "bench/commands.h"
#include "bench/omission_cases.h"
#include "bench/statistics.h"
#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/pipeline.h"

namespace caustream::bench {

namespace {

struct OmissionOptions {
    std::string gpu = "auto", markdown;
    int frames = 15, size = 512, photonGrid = 180;
};

// Largest difference of two pictures, of 255; of two maps, of 255 parts of the brightest texel.
double apart(const render::Frame& a, const render::Frame& b) {
    if (a.pixels.size() != b.pixels.size()) throw Error("two frames of one scene differ in size");
    double most = 0.0, brightest = 0.0;
    if (a.sample == render::Sample::U8) {
        for (std::size_t i = 0; i < a.pixels.size(); ++i) most = std::max(most, std::abs(double(a.pixels[i]) - double(b.pixels[i])));
        return most;
    }
    for (std::size_t i = 0; i + sizeof(float) <= a.pixels.size(); i += sizeof(float)) {
        float x = 0.0f, y = 0.0f;
        std::memcpy(&x, &a.pixels[i], sizeof x);
        std::memcpy(&y, &b.pixels[i], sizeof y);
        most = std::max(most, std::abs(double(x) - double(y)));
        brightest = std::max(brightest, double(x));
    }
    return brightest > 0.0 ? 255.0 * most / brightest : most;
}

void measureOmissions(const OmissionOptions& options) {
    const auto context = gl::Context::create({.gpu = options.gpu});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    pipeline.warmUp();
    std::printf("%s, %d x %d, map %d, photon grid %d, medians of %d frames in turn, calibration %.1f ms\n", context->renderer().c_str(),
                options.size, options.size, options.size, options.photonGrid, options.frames, calibrationMs());
    std::printf("%-54s %9s %9s %7s %6s\n", "left out", "done, ms", "not, ms", "ratio", "apart");
    std::string table = "| left out | done all the same, ms | left out, ms | ratio | quartiles of the ratio | pictures apart, of 255 |\n|---|---|---|---|---|---|\n";
    for (const OmissionCase& one : omissionCases(options.size, options.photonGrid)) {
        std::vector<double> done, left, ratios;
        double most = 0.0;
        const int warmUp = std::max(2, options.frames / 6);
        for (int i = 0; i < options.frames + warmUp; ++i) {
            render::Request request = one.moved(i + 1), forced = request;
            forced.forced.add(one.omission);
            // Whoever comes second finds caches warm: turn about.
            render::Frame a, b;
            if (i % 2) a = pipeline.run(request), b = pipeline.run(forced);
            else b = pipeline.run(forced), a = pipeline.run(request);
            most = std::max(most, apart(a, b));
            if (i < warmUp) continue;
            left.push_back(a.stats.renderMs);
            done.push_back(b.stats.renderMs);
            ratios.push_back(b.stats.renderMs / a.stats.renderMs);
        }
        const char* what = render::kOmissions[static_cast<std::size_t>(one.omission)].what;
        std::printf("%-54s %9.2f %9.2f %7.2f %6.2f\n", what, median(done), median(left), median(ratios), most);
        std::fflush(stdout);
        char row[512];
        std::snprintf(row, sizeof row, "| %s | %.2f | %.2f | %.2f | %.2f .. %.2f | %.2f |\n", what, median(done), median(left),
                      median(ratios), quantile(ratios, 0.25), quantile(ratios, 0.75), most);
        table += row;
    }
    if (options.markdown.empty()) return;
    std::ofstream out(options.markdown, std::ios::binary);
    out << table;
    if (!out) throw Error("cannot write " + options.markdown + "; check the path");
}

}  // namespace

void addOmissions(CLI::App& app) {
    const auto options = std::make_shared<OmissionOptions>();
    CLI::App* command = app.add_subcommand("omissions", "what each thing that frames leave out saves");
    command->add_option("--gpu", options->gpu, "auto, software, an index or part of a name")->capture_default_str();
    command->add_option("--frames", options->frames, "frames counted, each way")->check(CLI::Range(3, 10000))->capture_default_str();
    command->add_option("--photon-grid", options->photonGrid, "photons a side")->check(CLI::Range(16, 2048))->capture_default_str();
    command->add_option("--size", options->size, "pixels and map texels a side")->check(CLI::Range(64, 2048))->capture_default_str();
    command->add_option("--markdown", options->markdown, "writes the table to a file too");
    command->callback([options] { measureOmissions(*options); });
}

}  // namespace caustream::bench
