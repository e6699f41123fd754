#include "render/passes/dispersive_refraction.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "gl/uniforms.h"
#include "render/light_uniforms.h"
#include "shaders/shared/layout.h"

namespace caustream::render {

namespace {

constexpr std::size_t kNodes = 2, kSplitNodes = 8;  // traced exactly; the shader has room for 8
constexpr int kSurroundings = 8;  // texels a side, as the shader says
enum Unit : int { kFront, kBack, kReceiversDepth, kBackground, kSurroundingsUnit };

std::vector<gl::Flag> flags(bool thin, bool split, bool single, bool absorption, int views = 1) {
    return {{"THIN", thin}, {"SPLIT", split}, {"SINGLE", single}, {"ABSORPTION", absorption}, {"kViews", views}};
}

// Nodes are `most` of the wavelengths, spread evenly from the first to the last. A wavelength belongs to the node at or
// after it and lies between that and the one before by its index.
void setGlass(const gl::Uniforms& uniforms, const DispersiveRefraction::Glass& glass, std::size_t most, bool absorbs) {
    const auto& all = glass.wavelengths;
    const std::size_t count = std::min<std::size_t>(all.size(), layout::kMostWavelengths);
    std::vector<std::size_t> nodes;
    const std::size_t nodeCount = std::min(most, count);
    for (std::size_t n = 0; n < nodeCount; ++n) nodes.push_back(nodeCount == 1 ? 0 : n * (count - 1) / (nodeCount - 1));

    std::vector<glm::vec4> nodeValues, wavelengths;
    std::vector<float> absorption;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::size_t first = n == 0 ? 0 : nodes[n - 1] + 1, end = nodes[n] + 1;
        const float from = n == 0 ? 0.0f : all[nodes[n - 1]].index, range = all[nodes[n]].index - from;
        for (std::size_t i = first; i < end; ++i) {
            const float place = std::abs(range) > 1e-6f ? (all[i].index - from) / range : 1.0f;
            wavelengths.emplace_back(all[i].rgb, std::clamp(place, 0.0f, 1.0f));
            absorption.push_back(all[i].absorptionPerM);
        }
        nodeValues.emplace_back(all[nodes[n]].index, all[nodes[n]].absorptionPerM, float(first), float(end));
    }
    uniforms.set("u_nodeCount", static_cast<int>(nodes.size()))
        .set("u_nodes", std::span<const glm::vec4>(nodeValues))
        .set("u_wavelengths", std::span<const glm::vec4>(wavelengths));
    if (absorbs) uniforms.set("u_absorption", std::span<const float>(absorption));
}

// The key light in the camera's space.
void setKey(const gl::Uniforms& uniforms, const Lighting& lighting, const View& view) {
    if (lighting.lights.empty()) {
        uniforms.set("u_key.rgb", glm::vec3(0.0f));
        return;
    }
    scene::Light key = lighting.lights[0];
    key.position = view.toView(key.position);
    key.direction = glm::mat3(view.worldToView) * key.direction;
    setLight(uniforms, "u_key", key, lighting.keyRgb * irradianceScale(lighting));
}

}  // namespace

DispersiveRefraction::DispersiveRefraction(gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "linear")),
      vertexArray_(gl::makeVertexArray()) {}

void DispersiveRefraction::begin(const gl::Texture& frame) {
    background_.ensure(frame.width(), frame.height(), GL_RGBA16F, "background");
    glCopyImageSubData(frame.get(), GL_TEXTURE_2D, 0, 0, 0, 0, background_.get(), GL_TEXTURE_2D, 0, 0, 0, 0,
                       frame.width(), frame.height(), 1);

    surroundings_.ensure(kSurroundings, kSurroundings, GL_RGBA16F, "surroundings");
    const gl::Framebuffer target = gl::makeFramebuffer("surroundings", {surroundings_.get()});
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, kSurroundings, kSurroundings);
    const GLuint program = shaders_.program("surroundings");
    glUseProgram(program);
    gl::Uniforms(program).set("u_background", 0);
    glBindTextureUnit(0, background_.get());
    glBindVertexArray(vertexArray_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void DispersiveRefraction::run(const Inputs& in, const Settings& settings, gl::Texture& frame) {
    const int width = frame.width(), height = frame.height();
    const gl::Framebuffer target = gl::makeFramebuffer("dispersive_refraction", {frame.get()}, in.frontDepth ? in.frontDepth->get() : 0);
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    if (in.frontDepth) {   // the triangle lies at 0, as an empty layer does: it is drawn where the layer is more
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDepthMask(GL_FALSE);
    }
    glViewport(0, 0, width, height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(in.box.x, in.box.y, in.box.width, in.box.height);

    const bool split = settings.split && !in.glass.thinWalled;
    const auto& wavelengths = in.glass.wavelengths;
    const bool single = !in.glass.thinWalled && wavelengths.size() == 1 && !settings.forced.has(Omission::OneWavelength);
    const bool absorbs = !in.glass.thinWalled && (settings.forced.has(Omission::Absorption) ||
        std::any_of(wavelengths.begin(), wavelengths.end(), [](const Wavelength& w) { return w.absorptionPerM > 0.0f; }));
    const GLuint program = shaders_.program("dispersive_refraction", flags(in.glass.thinWalled, split, single, absorbs, viewsFlag({&in.view})));
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_view", in.view);
    // A bilinear lookup this far inside the box reads nothing beyond it.
    const float inset = 0.75f;
    uniforms.set("u_box", glm::vec4((float(in.box.x) + inset) / float(width), (float(in.box.y) + inset) / float(height),
                                    (float(in.box.x + in.box.width) - inset) / float(width),
                                    (float(in.box.y + in.box.height) - inset) / float(height)));
    uniforms.set("u_front", kFront)
        .set("u_back", kBack)
        .set("u_receiversDepth", kReceiversDepth)
        .set("u_background", kBackground)
        .set("u_surroundings", kSurroundingsUnit)
        .set("u_backSteps", settings.backSteps)
        .set("u_bounces", settings.bounces)
        .set("u_receiverSteps", settings.receiverSteps)
        .set("u_diameter", glm::length(in.bounds.max - in.bounds.min))
        .set("u_tint", in.glass.tint);
    if (!in.glass.thinWalled) setGlass(uniforms, in.glass, split ? kSplitNodes : kNodes, absorbs);
    setKey(uniforms, in.lighting, in.view);

    const GLuint textures[] = {in.front.get(), in.back.get(), in.receiversDepth.get(), background_.get(),
                               surroundings_.get()};
    glBindTextures(0, 5, textures);
    for (GLuint unit = 0; unit < 5; ++unit) glBindSampler(unit, linear_.get());
    glBindVertexArray(vertexArray_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSamplers(0, 5, nullptr);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);

    // The next caster sees this one.
    glCopyImageSubData(frame.get(), GL_TEXTURE_2D, 0, in.box.x, in.box.y, 0, background_.get(), GL_TEXTURE_2D, 0,
                       in.box.x, in.box.y, 0, in.box.width, in.box.height, 1);
}

void DispersiveRefraction::warmUp() {
    shaders_.program("surroundings");
    for (int bits = 0; bits < 8; ++bits) shaders_.program("dispersive_refraction", flags(false, bits & 1, bits & 2, bits & 4));
    shaders_.program("dispersive_refraction", flags(true, false, false, false));
}

}  // namespace caustream::render
