#include "render/passes/receiver_depth.h"

#include "render/plan.h"

namespace caustream::render {

void ReceiverDepth::run(const Inputs& in, gl::Texture& depth) {
    depth.ensure(in.size, in.size, GL_DEPTH_COMPONENT32F, "receiver depth");
    const gl::Framebuffer target = gl::makeFramebuffer("receiver_depth", {}, depth.get());
    const float farthest = 0.0f;
    glClearNamedFramebufferfv(target.get(), GL_DEPTH, 0, &farthest);
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, in.size, in.size);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    const GLuint program = shaders_.program("receiver_depth");
    glUseProgram(program);
    gl::Uniforms(program).set("u_worldToClip", in.view.worldToClip());
    in.scene.bind();
    in.scene.drawWhere([&](const scene::Object& object) {
        const scene::Material& material = in.materials[static_cast<std::size_t>(object.material)];
        if (in.leftOut && in.leftOut(object)) return false;
        return !material.caster || (in.casters && refracts(material, in.outsideIndex));
    });
    glDisable(GL_DEPTH_TEST);
}

}  // namespace caustream::render
