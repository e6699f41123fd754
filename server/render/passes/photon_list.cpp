#include "render/passes/photon_list.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "render/coarse_trace.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

void setEmission(const gl::Uniforms& uniforms, const scene::Light& light, const View& view, bool cookie) {
    const glm::mat3 toView(view.worldToView);
    const bool cone = light.type == scene::LightType::Spot;
    const float outer = glm::radians(light.outerConeDeg);
    uniforms.set("u_lightAxis", toView * light.direction)
        .set("u_coneVersine", cone ? glm::vec2(coneVersine(light.innerConeDeg), coneVersine(light.outerConeDeg)) : glm::vec2(3.0f, 4.0f));
    if (!cookie) return;
    // Cookie plane: x right and y up of the light's own frame, z along its axis; the outer cone spans -1..1.
    const glm::mat3 own(lookAlong(glm::vec3(0.0f), light.direction, glm::vec3(0, 1, 0)));
    const float scale = 1.0f / std::tan(std::min(outer, 1.5f));
    const glm::mat3 stretch(scale, 0, 0, 0, -scale, 0, 0, 0, -1);   // rows of a glTF image run downwards
    uniforms.set("u_viewToCookie", stretch * own * glm::transpose(toView)).set("u_cookie", 1);
}

void PhotonList::run(const Inputs& in, gl::Buffer& list, const gl::Buffer& ledger) {
    const std::size_t texels = static_cast<std::size_t>(in.front.width()) * static_cast<std::size_t>(in.front.height());
    list.ensure((layout::kListHeader + texels) * sizeof(GLuint), GL_DYNAMIC_STORAGE_BIT, "photon list");
    const GLuint header[layout::kListHeader] = {0, 1, 1, 0};
    glNamedBufferSubData(list.get(), 0, sizeof header, header);

    const GLuint program = shaders_.program("photon_list", {{"COOKIE", in.cookie ? 1 : 0}});
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_emission", in.emission);
    setEmission(uniforms, in.light, in.emission, in.cookie != 0);
    uniforms.set("u_front", 0);
    glBindTextureUnit(0, in.front.get());
    if (in.cookie) glBindTextureUnit(1, in.cookie);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindList, list.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindLedger, ledger.get());
    const std::size_t perGroup = static_cast<std::size_t>(layout::kGroupSize) * layout::kScanTexels;
    glDispatchCompute(static_cast<GLuint>((texels + perGroup - 1) / perGroup), 1, 1);
}

}  // namespace caustream::render
