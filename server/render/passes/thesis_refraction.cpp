#include "render/passes/thesis_refraction.h"

#include <span>
#include <vector>

#include "render/light_uniforms.h"

namespace caustream::render {

ThesisRefraction::ThesisRefraction(gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "thesis refraction")),
      vertexArray_(gl::makeVertexArray()) {}

void ThesisRefraction::begin(const gl::Texture& frame) {
    background_.ensure(frame.width(), frame.height(), GL_RGBA16F, "background");
    glCopyImageSubData(frame.get(), GL_TEXTURE_2D, 0, 0, 0, 0, background_.get(), GL_TEXTURE_2D, 0, 0, 0, 0,
                       frame.width(), frame.height(), 1);
}

void ThesisRefraction::run(const Inputs& in, gl::Texture& frame) {
    const gl::Framebuffer target = gl::makeFramebuffer("thesis_refraction", {frame.get()});
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, frame.width(), frame.height());

    std::vector<glm::vec4> wavelengths;
    std::vector<float> absorption;
    for (const auto& wavelength : in.glass.wavelengths) {
        wavelengths.emplace_back(wavelength.rgb, wavelength.index);
        absorption.push_back(wavelength.absorptionPerM);
    }
    const GLuint program = shaders_.program("thesis_refraction");
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_view", in.view);
    uniforms.set("u_front", 0)
        .set("u_back", 1)
        .set("u_receiversDepth", 2)
        .set("u_background", 3)
        .set("u_count", static_cast<int>(wavelengths.size()))
        .set("u_wavelengths", std::span<const glm::vec4>(wavelengths))
        .set("u_absorption", std::span<const float>(absorption))
        .set("u_keyColour", in.lighting.keyRgb)
        .set("u_environment", in.lighting.environmentRadiance / radianceUnit(in.lighting));
    if (!in.lighting.lights.empty()) {
        scene::Light key = in.lighting.lights[0];
        key.position = in.view.toView(key.position);
        key.direction = glm::mat3(in.view.worldToView) * key.direction;
        setLight(uniforms, "u_key", key, in.lighting.keyRgb);
    }
    const GLuint textures[] = {in.front.get(), in.back.get(), in.receiversDepth.get(), background_.get()};
    glBindTextures(0, 4, textures);
    for (GLuint unit = 0; unit < 4; ++unit) glBindSampler(unit, linear_.get());
    glBindVertexArray(vertexArray_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSamplers(0, 4, nullptr);
}

}  // namespace caustream::render
