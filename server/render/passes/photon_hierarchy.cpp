#include "render/passes/photon_hierarchy.h"

#include <utility>

#include "gl/uniforms.h"

namespace caustream::render {

namespace {

void ensure(PhotonPoints& points, std::size_t bytes) {
    if (!points.feedback) {
        points.feedback = gl::makeTransformFeedback();
        points.vertices = gl::makeVertexArray();
        glEnableVertexArrayAttrib(points.vertices.get(), 0);
        glVertexArrayAttribIFormat(points.vertices.get(), 0, 1, GL_UNSIGNED_INT, 0);
        glVertexArrayAttribBinding(points.vertices.get(), 0, 0);
    }
    if (!points.cells.ensure(bytes, 0, "photon cells")) return;
    glTransformFeedbackBufferBase(points.feedback.get(), 0, points.cells.get());
    glVertexArrayVertexBuffer(points.vertices.get(), 0, points.cells.get(), 0, sizeof(GLuint));
}

}  // namespace

int hierarchyLevels(int side, int asked) {
    int levels = 0;
    while (levels < asked && side % (2 << levels) == 0) ++levels;
    return levels;
}

const PhotonPoints& PhotonHierarchy::run(const Inputs& in) {
    const int side = in.front.width(), start = side >> in.levels;
    for (PhotonPoints& points : points_) ensure(points, static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * sizeof(GLuint));
    if (in.levels > 0) glGenerateTextureMipmap(in.front.get());

    glBindFramebuffer(GL_FRAMEBUFFER, nowhere_.get());
    glEnable(GL_RASTERIZER_DISCARD);
    glBindTextureUnit(0, in.front.get());
    for (int level = in.levels; level >= 0; --level) {
        const bool first = level == in.levels, leaf = level == 0;
        const GLuint program = shaders_.program("photon_hierarchy", {{"START", first}, {"LEAF", leaf}});
        glUseProgram(program);
        gl::Uniforms(program).set("u_front", 0).set("u_level", level).set("u_side", static_cast<unsigned>(start));
        const PhotonPoints &from = points_[1], &to = points_[0];
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, to.feedback.get());
        glBindVertexArray(first ? empty_.get() : from.vertices.get());
        if (leaf && in.query) glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, in.query);
        glBeginTransformFeedback(GL_POINTS);
        if (first) glDrawArrays(GL_POINTS, 0, start * start);
        else glDrawTransformFeedback(GL_POINTS, from.feedback.get());
        glEndTransformFeedback();
        if (leaf && in.query) glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
        std::swap(points_[0], points_[1]);
    }
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    glDisable(GL_RASTERIZER_DISCARD);
    return points_[1];
}

}  // namespace caustream::render
