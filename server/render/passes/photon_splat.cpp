#include "render/passes/photon_splat.h"

#include <span>

#include "gl/uniforms.h"
#include "render/passes/photon_list.h"

namespace caustream::render {

void PhotonSplat::run(const Inputs& in, bool alpha, const gl::Texture& map) {
    const gl::Framebuffer target = gl::makeFramebuffer("photon_splat", {map.get()});
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, map.width(), map.height());

    std::vector<float> index;
    std::vector<glm::vec4> weight;
    for (const Wavelength& wavelength : in.wavelengths) {
        index.push_back(wavelength.index);
        weight.push_back(wavelength.weight);
    }
    const GLuint program = shaders_.program(
        "photon_splat", {{"kWavelengths", static_cast<int>(index.size())}, {"COOKIE", in.cookie ? 1 : 0}});
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_lightView", in.view);
    setEmission(uniforms, in.light, in.view, in.cookie != 0);
    uniforms.set("u_front", 0)
        .set("u_back", 2)
        .set("u_receivers", 3)
        .set("u_mapSize", glm::ivec2(map.width(), map.height()))
        .set("u_index", std::span<const float>(index))
        .set("u_weight", std::span<const glm::vec4>(weight));
    glBindTextureUnit(0, in.front.get());
    if (in.cookie) glBindTextureUnit(1, in.cookie);   // where setEmission() looks for it
    glBindTextureUnit(2, in.back.get());
    glBindTextureUnit(3, in.receivers.get());
    glBindSampler(2, linear_.get());
    glBindSampler(3, linear_.get());

    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, alpha);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glPointSize(3.0f);   // the splat's 2.5 pixels, wherever its centre lies
    glBindVertexArray(in.photons.vertices.get());
    glDrawTransformFeedback(GL_POINTS, in.photons.feedback.get());
    glBindSampler(2, 0);
    glBindSampler(3, 0);
    glDisable(GL_BLEND);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace caustream::render
