#include "render/passes/first_surface.h"

#include "gl/uniforms.h"

namespace caustream::render {

void FirstSurface::run(const Inputs& in, const Outputs& out) {
    out.surface.ensure(in.width, in.height, GL_RGBA32F, "first surface");
    out.label.ensure(in.width, in.height, GL_R32F, "first surface's caster");
    depth_.ensure(in.width, in.height, GL_DEPTH_COMPONENT32F, "first surface depth");
    const gl::Framebuffer target = gl::makeFramebuffer("first_surface", {out.surface.get(), out.label.get()}, depth_.get());

    const float nothing[4] = {}, farthest = 0.0f;
    for (const GLint image : {0, 1}) glClearNamedFramebufferfv(target.get(), GL_COLOR, image, nothing);
    glClearNamedFramebufferfv(target.get(), GL_DEPTH, 0, &farthest);
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, in.width, in.height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);

    const GLuint program = shaders_.program("first_surface");
    glUseProgram(program);
    const gl::Uniforms uniforms(program);
    uniforms.set("u_worldToClip", in.view.worldToClip()).set("u_worldToView", in.view.worldToView);
    in.scene.bind();
    int casters = 0;
    for (const scene::Object& object : in.scene.geometry().objects) {
        const bool caster = in.materials[static_cast<std::size_t>(object.material)].caster;
        uniforms.set("u_label", caster ? static_cast<float>(++casters) : 0.0f);
        in.scene.draw(object);
    }
    glDisable(GL_DEPTH_TEST);
}

}  // namespace caustream::render
