#include "render/passes/camera_receivers.h"

#include <algorithm>

#include "gl/uniforms.h"
#include "render/light_uniforms.h"
#include "render/passes/camera_casters.h"

namespace caustream::render {

namespace {

// MAP of the shader.
enum Maps : int { kNoMap, kInnerMap, kBothMaps };

enum Unit : int { kBaseColor, kShading };

std::vector<gl::Flag> flags(bool shadow, int map, bool texture, bool full, int views = 1) {
    return {{"SHADOW", shadow}, {"MAP", map}, {"TEXTURE", texture}, {"FULL", full}, {"RAYS", 0}, {"kViews", views}};
}

}  // namespace

bool glossy(const scene::Material& material) { return material.roughness < 0.95f || material.metallic > 0.0f; }

bool inView(const scene::Object& object, const View& view) {
    const int grid = 256;  // the answer errs by one cell, to the safe side
    return !projectedBox(object.bounds, view, grid, grid).empty();
}

CameraReceivers::CameraReceivers(gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      trilinear_(gl::makeSampler(GL_LINEAR_MIPMAP_LINEAR, GL_REPEAT, "base colour")) {
    const std::uint8_t white[4] = {255, 255, 255, 255};
    white_.ensure(1, 1, GL_RGBA8, "white");
    glTextureSubImage2D(white_.get(), 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, white);
}

void CameraReceivers::setFrame(const Inputs& in, GLuint program) const {
    const gl::Uniforms uniforms(program);
    uniforms.set("u_worldToClip", in.view.worldToClip()).set("u_baseColorTexture", kBaseColor);
    shading_.bind(uniforms, kShading, in.scene, in.lighting, in.view);
}

void CameraReceivers::setMaterial(const Inputs& in, const scene::Material& material, GLuint program) const {
    const gl::Uniforms uniforms(program);
    uniforms.set("u_baseColor", glm::vec3(material.baseColor))
        .set("u_emissive", material.emissive / radianceUnit(in.lighting))
        .set("u_roughness", material.roughness)
        .set("u_metallic", material.metallic)
        .set("u_gloss", glossy(material) ? 1.0f : 0.0f);
    glBindTextureUnit(kBaseColor, material.baseColorTexture >= 0 ? in.scene.texture(material.baseColorTexture) : white_.get());
}

void CameraReceivers::run(const Inputs& in, const Outputs& out) {
    out.color.ensure(in.width, in.height, GL_RGBA16F, "receivers' colour");
    out.depth.ensure(in.width, in.height, GL_DEPTH_COMPONENT32F, "receivers' depth");
    const gl::Framebuffer target = gl::makeFramebuffer("camera_receivers", {out.color.get()}, out.depth.get());
    const Lighting& lighting = in.lighting;

    const glm::vec4 background(lighting.environmentRadiance / radianceUnit(lighting), 1.0f);
    const float nothing = 0.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, in.width, in.height);
    glClearNamedFramebufferfv(target.get(), GL_COLOR, 0, &background[0]);
    glClearNamedFramebufferfv(target.get(), GL_DEPTH, 0, &nothing);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);

    const bool map = lighting.hasMap;
    glBindSampler(kBaseColor, trilinear_.get());

    const View& first = lighting.hasShadow ? lighting.shadowView : lighting.mapView;   // of any, where there is none
    const int views = hasCookie(lighting) ? 0 : viewsFlag({&first, map ? &lighting.mapView : &first, map ? &lighting.outerView : &first});

    // One draw per receiver; a variant's frame uniforms are set when it is first used.
    in.scene.bind();
    std::vector<GLuint> ready;
    for (const scene::Object& object : in.scene.geometry().objects) {
        const scene::Material& material = in.materials[static_cast<std::size_t>(object.material)];
        if (material.caster || (in.mirrorsApart && material.mirror)) continue;
        const bool shadow = lighting.hasShadow && (inView(object, lighting.shadowView) || in.forced.has(Omission::ShadowLookup));
        const bool lit = map && (inView(object, lighting.outerView) || in.forced.has(Omission::MapLookup));
        const bool outer = lighting.hasOuterMap || in.forced.has(Omission::OuterMap);
        const bool full = hasCookie(lighting) || lighting.lights.size() > 1 || glossy(material) || in.forced.has(Omission::Gloss);
        const bool texture = material.baseColorTexture >= 0 || in.forced.has(Omission::Textures);
        const GLuint program = shaders_.program(in.asPublished ? "thesis_receivers" : "camera_receivers",
                                               flags(shadow, !lit ? kNoMap : outer ? kBothMaps : kInnerMap, texture, full, views));
        if (std::find(ready.begin(), ready.end(), program) == ready.end()) {
            setFrame(in, program);
            ready.push_back(program);
        }
        setMaterial(in, material, program);
        glUseProgram(program);
        in.scene.draw(object);
    }
    glDisable(GL_DEPTH_TEST);
    glBindSampler(kBaseColor, 0);
    ReceiverShading::unbind(kShading);
}

void CameraReceivers::warmUp() {
    for (int bits = 0; bits < 8; ++bits) {
        for (const int map : {kNoMap, kInnerMap, kBothMaps}) shaders_.program("camera_receivers", flags(bits & 1, map, bits & 2, bits & 4));
    }
}

}  // namespace caustream::render
