#include "render/passes/photon_trace.h"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>

#include "render/passes/photon_list.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

namespace {

struct Variant {
    bool absorption = false, bands = false, cookie = false;
    int nodes = 0;
    bool residuals = false, retry = false;
    int views = 1;
};

std::vector<gl::Flag> flags(const Variant& v) {
    return {{"ABSORPTION", v.absorption}, {"BANDS", v.bands}, {"CONTINUOUS", v.nodes > 0}, {"COOKIE", v.cookie}, {"kNodes", v.nodes},
            {"RESIDUALS", v.residuals}, {"RETRY", v.retry}, {"kViews", v.views}};
}

bool absorbs(const PhotonTrace::Inputs& in) {
    const auto any = [](const auto& list) { return std::any_of(list.begin(), list.end(), [](const auto& at) { return at.absorptionPerM > 0.0; }); };
    return in.absorption || any(in.wavelengths) || any(in.spectrum);
}

}  // namespace

void PhotonTrace::dispatch(const Inputs& in, int retryList, const gl::Buffer& groups) {
    const bool retry = retryList >= 0, absorption = absorbs(in);
    const GLuint program = shaders_.program(
        "photon_trace", flags({.absorption = absorption, .bands = in.bands > 0, .cookie = in.cookie != 0,
                               .nodes = in.spectrum.empty() ? 0 : static_cast<int>(in.wavelengths.size()), .residuals = in.residuals != nullptr,
                               .retry = retry, .views = viewsFlag({&in.emission, &in.backView, &in.mapView, &in.outerView})}));
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_emission", in.emission);
    setView(uniforms, "u_backView", in.backView);
    setView(uniforms, "u_mapView", in.mapView);
    setView(uniforms, "u_outerView", in.outerView);
    setEmission(uniforms, in.light, in.emission, in.cookie != 0);
    uniforms.set("u_emissionToBack", in.backView.worldToView * glm::affineInverse(in.emission.worldToView))
        .set("u_backToMap", in.mapView.worldToView * glm::affineInverse(in.backView.worldToView));

    std::vector<glm::vec4> glass, xyz;
    for (const TracedWavelength& wavelength : in.wavelengths) {
        glass.emplace_back(wavelength.indexRatio, wavelength.absorptionPerM, wavelength.luminance, glass.size());
        xyz.emplace_back(wavelength.xyz, 0.0);
    }
    std::vector<glm::vec4> cumulative;
    std::vector<float> perM;
    for (const SpectrumStep& step : in.spectrum) {
        cumulative.emplace_back(step.cumulativeXyz, step.indexRatio);
        perM.push_back(static_cast<float>(step.absorptionPerM));
    }
    if (!in.spectrum.empty()) uniforms.set("u_cumulative", cumulative);
    if (!in.spectrum.empty() && absorption) uniforms.set("u_absorption", perM);
    if (retry) uniforms.set("u_retryList", retryList);
    uniforms.set("u_wavelengths", static_cast<int>(glass.size()))
        .set("u_bands", in.bands)
        .set("u_glass", glass)
        .set("u_xyz", xyz)
        .set("u_fixedPerFlux", static_cast<float>(in.fixedPerFlux))
        .set("u_ledgerPerFlux", static_cast<float>(in.ledgerPerFlux))
        .set("u_levels", in.levels)
        .set("u_backSteps", in.backSteps)
        .set("u_receiverSteps", in.receiverSteps)
        .set("u_exitTolerance", in.exitToleranceM)
        .set("u_reach", in.reachM)
        .set("u_front", 0)
        .set("u_back", 2)
        .set("u_receivers", 3)
        .set("u_outerReceivers", 4);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.get());
    glDispatchComputeIndirect(static_cast<GLintptr>(std::max(retryList, 0) * layout::kListHeader * static_cast<int>(sizeof(GLuint))));
}

void PhotonTrace::run(const Inputs& in, const Outputs& out) {
    const std::size_t photons = static_cast<std::size_t>(in.front.width()) * static_cast<std::size_t>(in.front.height());
    const GLuint header[2 * layout::kListHeader] = {0, 1, 1, 0, 0, 1, 1, 0};
    retry_.ensure(sizeof header + photons * 4 * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "photons to trace again");
    glNamedBufferSubData(retry_.get(), 0, sizeof header, header);

    glBindTextureUnit(0, in.front.get());
    if (in.cookie) glBindTextureUnit(1, in.cookie);
    glBindTextureUnit(2, in.back.get());
    glBindTextureUnit(3, in.receivers.get());
    glBindTextureUnit(4, in.outerReceivers.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindList, in.list.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindMap, out.map.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, out.ledger.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindRetry, retry_.get());
    if (in.residuals) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindResiduals, in.residuals->get());
    dispatch(in, -1, in.list);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);   // retry lists -> their dispatches
    for (const int list : {0, 1}) dispatch(in, list, retry_);
}

// Without what few scenes have: a cookie, absorption in a directional light.
void PhotonTrace::warmUp(gl::ShaderLibrary& shaders, int nodes) {
    for (const bool retry : {false, true}) {
        for (const bool absorption : {false, true}) {
            shaders.program("photon_trace", flags({.absorption = absorption, .retry = retry}));
            shaders.program("photon_trace", flags({.absorption = absorption, .nodes = nodes, .retry = retry}));
        }
        shaders.program("photon_trace", flags({.bands = true, .retry = retry}));
    }
}

}  // namespace caustream::render
