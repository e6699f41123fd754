#include "render/passes/camera_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

#include "gl/uniforms.h"
#include "render/light_uniforms.h"
#include "render/passes/camera_receivers.h"

namespace caustream::render {

namespace {

enum Unit : GLuint { kBackground, kDepth, kReceivers, kMean, kTable, kShading = kTable + 2, kSurfaces = kShading + ReceiverShading::kUnits };

float fromSrgb(std::uint8_t value) {
    const float x = static_cast<float>(value) / 255.0f;
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

// Mean linear colour, of some thousand texels.
glm::vec3 meanColour(const scene::Texture& texture) {
    const std::size_t texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
    const std::size_t step = std::max<std::size_t>(1, texels / 4096) | 1;   // odd: not a column of its own
    glm::vec3 sum(0.0f);
    float count = 0.0f;
    for (std::size_t i = 0; i < texels; i += step, count += 1.0f) {
        sum += glm::vec3(fromSrgb(texture.rgba[4 * i]), fromSrgb(texture.rgba[4 * i + 1]), fromSrgb(texture.rgba[4 * i + 2]));
    }
    return count > 0.0f ? sum / count : glm::vec3(1.0f);
}

bool touch(const PixelBox& a, const PixelBox& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

PixelBox around(const PixelBox& a, const PixelBox& b) {
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

}  // namespace

std::vector<PixelBox> apart(std::vector<PixelBox> boxes) {
    std::erase_if(boxes, [](const PixelBox& box) { return box.empty(); });
    for (std::size_t i = 0; i < boxes.size();) {
        const auto other = std::find_if(boxes.begin() + static_cast<std::ptrdiff_t>(i) + 1, boxes.end(),
                                        [&](const PixelBox& box) { return touch(boxes[i], box); });
        if (other == boxes.end()) {
            ++i;
            continue;
        }
        boxes[i] = around(boxes[i], *other);
        boxes.erase(other);
        i = 0;   // grown, it may touch one that was passed
    }
    return boxes;
}

CameraPaths::CameraPaths(gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      linear_(gl::makeSampler(GL_LINEAR, GL_CLAMP_TO_EDGE, "linear")),
      vertexArray_(gl::makeVertexArray()) {}

// What is known of receivers that the camera does not see.
void CameraPaths::setReceivers(const Inputs& in) {
    const auto& geometry = in.scene.geometry;
    if (geometry_.lock() != geometry) {
        geometry_ = geometry;
        textureMeans_.clear();
        for (const scene::Texture& texture : geometry->textures) textureMeans_.push_back(meanColour(texture));
    }
    std::vector<glm::vec4> texels;
    for (const scene::Object& object : geometry->objects) {
        const scene::Material& material = in.scene.materials[static_cast<std::size_t>(object.material)];
        const bool textured = material.baseColorTexture >= 0;
        const glm::vec3 mean = textured ? textureMeans_[static_cast<std::size_t>(material.baseColorTexture)] : glm::vec3(1.0f);
        texels.emplace_back(glm::vec3(material.baseColor) * mean, material.roughness);
        texels.emplace_back(material.emissive / radianceUnit(in.lighting), material.metallic);
    }
    if (texels == receiversNow_) return;
    receiversNow_ = texels;
    receivers_ = gl::Buffer(texels.size() * sizeof(glm::vec4), texels.data(), 0, "receivers");
    receiverTexels_.view(receivers_, GL_RGBA32F);
}

void CameraPaths::run(const Inputs& in, const Settings& settings, gl::Texture& frame) {
    const int width = frame.width(), height = frame.height();
    std::vector<PixelBox> boxes;
    for (const ExactCaster& caster : in.surfaces.casters()) {
        boxes.push_back(projectedBox(in.scene.geometry->objects[caster.object].bounds, in.view, width, height));
    }
    boxes = in.everywhere ? std::vector<PixelBox>{{0, 0, width, height}} : apart(std::move(boxes));
    if (boxes.empty()) return;

    background_.ensure(width, height, GL_RGBA16F, "background");
    glCopyImageSubData(frame.get(), GL_TEXTURE_2D, 0, 0, 0, 0, background_.get(), GL_TEXTURE_2D, 0, 0, 0, 0, width, height, 1);
    setReceivers(in);
    table_.fill(in.scene, in.surfaces.casters(), in.spectrum);

    const Lighting& lighting = in.lighting;
    const auto& materials = in.scene.materials;
    const bool full = hasCookie(lighting) || lighting.lights.size() > 1 ||
                      std::any_of(materials.begin(), materials.end(), [](const scene::Material& m) { return m.metallic > 0.0f && !m.mirror; });
    // A lone convex caster hides nothing of its own front: its triangles say where the camera's rays meet it.
    const PixelBox all{0, 0, width, height};
    const bool drawn = in.surfaces.lone() && boxes.front() != all && in.view.perspective;
    std::vector<gl::Flag> flags = in.surfaces.flags(true);
    flags.insert(flags.end(), {{"SHADOW", lighting.hasShadow}, {"MAP", !lighting.hasMap || !settings.caustics ? 0 : lighting.hasOuterMap ? 2 : 1}, {"FULL", full}, {"RAYS", 1}, {"DRAWN", drawn}, {"KNOWN", in.mean != nullptr}});
    const GLuint program = shaders_.program("camera_paths", flags);
    const gl::Uniforms uniforms(program);
    setView(uniforms, "u_view", in.view);
    const int entries = static_cast<int>(in.spectrum.nm.size());
    const int rays = std::min(settings.rays, entries);
    uniforms.set("u_viewToWorld", glm::affineInverse(in.view.worldToView))
        .set("u_worldToClip", in.view.worldToClip())
        .set("u_shift", 0.5f * in.view.shift)
        .set("u_xyzToRgb", in.xyzToRgb)
        .set("u_rays", rays)
        .set("u_entries", entries)
        .set("u_entryShare", in.spectrum.continuous ? 1.0f : static_cast<float>(entries))
        .set("u_rotation", settings.rotation)
        .set("u_bounces", settings.bounces)
        .set("u_least", settings.least)
        .set("u_branches", std::clamp(settings.branches, 0, 6))
        .set("u_sample", settings.sample)
        .set("u_background", int(kBackground))
        .set("u_receiversDepth", int(kDepth))
        .set("u_receivers", int(kReceivers))
        .set("u_mean", int(kMean));
    in.surfaces.bind(uniforms, kSurfaces, true);
    table_.bind(uniforms, kTable);
    shading_.bind(uniforms, kShading, in.gpu, lighting, in.view);
    glBindTextureUnit(kBackground, background_.get());
    glBindTextureUnit(kDepth, in.receiversDepth.get());
    glBindTextureUnit(kReceivers, receiverTexels_.get());
    if (in.mean) glBindTextureUnit(kMean, in.mean->get());
    glBindSampler(kBackground, linear_.get());

    const gl::Framebuffer target = gl::makeFramebuffer("camera_paths", {frame.get()});
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, width, height);
    glUseProgram(program);
    if (drawn) {
        in.gpu.bind();
        glEnable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        in.gpu.draw(in.scene.geometry->objects[in.surfaces.casters().front().object]);
        glDisable(GL_CULL_FACE);
    } else {
        glBindVertexArray(vertexArray_.get());
        glEnable(GL_SCISSOR_TEST);
        for (const PixelBox& box : boxes) {
            glScissor(box.x, box.y, box.width, box.height);
            glDrawArrays(GL_TRIANGLES, 0, 3);
        }
        glDisable(GL_SCISSOR_TEST);
    }
    glBindSampler(kBackground, 0);
    ReceiverShading::unbind(kShading);
}

}  // namespace caustream::render
