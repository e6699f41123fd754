#include "render/passes/photon_trace.h"

#include <glm/gtc/matrix_inverse.hpp>

#include "render/passes/photon_list.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

void PhotonTrace::dispatch(const Inputs& in, int retry, const gl::Buffer& groups) {
    const GLuint program = shaders_.program(
        "photon_trace", {{"BANDS", in.bands > 0 ? 1 : 0}, {"CONTINUOUS", in.spectrum.empty() ? 0 : 1}, {"COOKIE", in.cookie ? 1 : 0},
                         {"RESIDUALS", in.residuals ? 1 : 0}, {"RETRY", retry}});
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
    std::vector<float> absorption;
    for (const SpectrumStep& step : in.spectrum) {
        cumulative.emplace_back(step.cumulativeXyz, step.indexRatio);
        absorption.push_back(static_cast<float>(step.absorptionPerM));
    }
    if (!in.spectrum.empty()) uniforms.set("u_cumulative", cumulative).set("u_absorption", absorption);
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
    glDispatchComputeIndirect(0);
}

void PhotonTrace::run(const Inputs& in, const Outputs& out) {
    const std::size_t photons = static_cast<std::size_t>(in.front.width()) * static_cast<std::size_t>(in.front.height());
    retry_.ensure((1 + photons) * 4 * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "photons to trace again");
    const GLuint header[layout::kListHeader] = {0, 1, 1, 0};
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
    dispatch(in, 0, in.list);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);   // retry list -> its dispatch
    dispatch(in, 1, retry_);
}

}  // namespace caustream::render
