#include "render/passes/caster_layers.h"

namespace caustream::render {

void CasterLayers::run(const Inputs& in, Side side, gl::Texture& layer) {
    layer.ensure(in.width, in.height, GL_RGBA32F, side == Side::Front ? "front layer" : "back layer", in.levels);
    depth_.ensure(in.width, in.height, GL_DEPTH_COMPONENT32F, "caster layers depth");
    const gl::Framebuffer target = gl::makeFramebuffer("caster_layers", {layer.get()}, depth_.get());

    const float nothing[4] = {}, farthest = 0.0f;
    glClearNamedFramebufferfv(target.get(), GL_COLOR, 0, nothing);
    glClearNamedFramebufferfv(target.get(), GL_DEPTH, 0, &farthest);
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, in.width, in.height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);

    const GLuint program = shaders_.program("caster_layers");
    glUseProgram(program);
    gl::Uniforms(program).set("u_worldToClip", in.view.worldToClip()).set("u_worldToView", in.view.worldToView);
    in.scene.bind();
    if (in.drawOccluders) {
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        // A parallel view begins just before the caster; what stands farther before it hides it all the same.
        if (!in.view.perspective) glEnable(GL_DEPTH_CLAMP);
        in.drawOccluders();
        glDisable(GL_DEPTH_CLAMP);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    glEnable(GL_CULL_FACE);
    glCullFace(side == Side::Front ? GL_BACK : GL_FRONT);
    in.scene.draw(in.caster);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace caustream::render
