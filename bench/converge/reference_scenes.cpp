#include "bench/converge/reference_scenes.h"

#include <algorithm>
#include <cmath>

#include "bench/accuracy/subject.h"
#include "bench/accuracy/tables.h"

namespace caustream::bench {

std::vector<ReferenceRow> compareReferences(Renderer& renderer) {
    std::vector<ReferenceRow> rows;
    for (const char* scene : {"gem", "prism", "sphere"}) {
        const Subject subject = loadSubject("reference:" + std::string(scene));
        const std::size_t area = subject.plane->weights().size(), bands = bandsNm().size();
        for (const render::Mode mode : {render::Mode::Refined, render::Mode::Traced}) {
            Configuration configuration;
            configuration.transport.mode = mode;
            configuration.transport.photonGrid = configuration.transport.mapSize = 1024;
            configuration.transport.wavelengthsNm = bandsNm();
            render::Request request = mapRequest(subject.scene, configuration);
            request.wavelengthBands = true;
            const std::vector<float> map = mapOnWindow(renderer.pipeline(configuration, subject.fingerprint), request, *subject.plane, 8);
            ReferenceRow row{.scene = scene, .mode = mode == render::Mode::Traced ? "traced" : "refined"};
            for (std::size_t i = 0; i < bands; ++i) {
                const tracer::Difference d = tracer::difference(&map[i * area], &subject.storedBands->values[i * area], subject.plane->cells(), subject.plane->cells());
                row.relativeL1 += d.relativeL1 / static_cast<double>(bands), row.flux += d.fluxRatio / static_cast<double>(bands);
                if (std::abs(d.fluxRatio - 1.0) > std::abs(row.worstFlux - 1.0)) row.worstFlux = d.fluxRatio;
                row.centroidCells = std::max(row.centroidCells, d.centroidCells);
            }
            rows.push_back(row);
        }
        renderer.forget();
    }
    return rows;
}

std::string referenceTable(const std::vector<ReferenceRow>& rows) {
    std::vector<std::vector<std::string>> text = {{"tests/reference, photon grid and map 1024", "relative L1", "flux", "worst wavelength's", "worst centroid, cells"}};
    for (const ReferenceRow& r : rows) {
        text.push_back({r.scene + ", " + r.mode, format("%.4f", r.relativeL1), format("%.4f", r.flux), format("%.4f", r.worstFlux), format("%.3f", r.centroidCells)});
    }
    return table(text);
}

std::string referenceClaims(const std::vector<ReferenceRow>& rows) {
    std::string text;
    for (std::size_t i = 1; i < rows.size(); i += 2) {   // refined, traced
        const ReferenceRow &refined = rows[i - 1], &traced = rows[i];
        const double most = traced.scene == "gem" ? 0.03 : refined.relativeL1;
        text += claim(traced.relativeL1 <= most, format("%s, traced: %.4f of the reference (%s %.4f)", traced.scene.c_str(), traced.relativeL1,
                                                        traced.scene == "gem" ? "at most" : "refined:", most));
        text += claim(std::abs(traced.worstFlux - 1.0) <= 0.01 && traced.centroidCells <= 0.5,
                      format("%s, traced: flux within %.2f%% (1%%), centroids within %.2f cells (.5)", traced.scene.c_str(), 100.0 * std::abs(traced.worstFlux - 1.0),
                             traced.centroidCells));
    }
    return text;
}

}  // namespace caustream::bench
