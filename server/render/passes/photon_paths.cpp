#include "render/passes/photon_paths.h"

#include <glm/gtc/matrix_inverse.hpp>

#include "render/passes/photon_list.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

namespace {

constexpr float kLeastShare = 1e-3f;   // of a photon: weaker branches are booked, not followed
enum Unit : GLuint { kReceivers, kCookie, kOuterReceivers, kTable, kSurfaces = kTable + 2 };

}  // namespace

void PhotonPaths::run(const Inputs& in, const Outputs& out) {
    if (in.photons == 0) return;
    std::vector<gl::Flag> flags = in.surfaces.flags(in.exactReceivers);
    flags.insert(flags.end(), {{"BANDS", in.bandShare > 0.0 ? 1 : 0}, {"COOKIE", in.cookie ? 1 : 0}, {"HIDDEN", in.hidden ? 1 : 0}, {"RESIDUALS", 0}});
    const GLuint program = shaders_.program("photon_paths", flags);
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_emission", in.emission);
    setView(uniforms, "u_mapView", in.mapView);
    setView(uniforms, "u_outerView", in.outerView);
    setEmission(uniforms, in.light, in.emission, in.cookie != 0);
    in.table.bind(uniforms, kTable);
    in.surfaces.bind(uniforms, kSurfaces, in.exactReceivers);
    glBindTextureUnit(kReceivers, in.receivers.get());
    if (in.cookie) glBindTextureUnit(kCookie, in.cookie);
    glBindTextureUnit(kOuterReceivers, in.outerReceivers.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindMap, out.map.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindOuterMap, out.outerMap.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLandings, out.landings.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindOuterLandings, out.outerLandings.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, out.ledger.get());
    const glm::vec2 h = in.emission.halfExtent;
    uniforms.set("u_emissionToWorld", glm::affineInverse(in.emission.worldToView))
        .set("u_receivers", static_cast<int>(kReceivers))
        .set("u_outerReceivers", static_cast<int>(kOuterReceivers))
        .set("u_firstPhoton", in.firstPhoton)
        .set("u_photons", in.photons)
        .set("u_emitter", in.emitter)
        .set("u_spectra", in.spectra)
        .set("u_firstEntry", in.firstEntry)
        .set("u_entries", in.entries)
        .set("u_continuous", in.continuous)
        .set("u_bandShare", static_cast<float>(in.bandShare))
        .set("u_fullExtent", 4.0f * h.x * h.y)
        .set("u_bounces", in.bounces)
        .set("u_receiverSteps", in.receiverSteps)
        .set("u_least", kLeastShare)
        .set("u_fixedPerFlux", static_cast<float>(in.fixedPerFlux))
        .set("u_ledgerPerFlux", static_cast<float>(in.ledgerPerFlux))
        .set("u_reach", in.reachM);
    const std::uint32_t threads = in.photons * static_cast<std::uint32_t>(in.spectra);
    glDispatchCompute((threads + layout::kGroupSize - 1) / layout::kGroupSize, 1, 1);
}

}  // namespace caustream::render
