#include "render/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <string>

namespace caustream::render {

glm::mat4 View::viewToClip() const {
    glm::mat4 clip(0.0f);
    clip[0][0] = 1.0f / halfExtent.x;
    clip[1][1] = 1.0f / halfExtent.y;
    if (perspective) {
        clip[2][0] = -shift.x;
        clip[2][1] = -shift.y;
        clip[2][3] = -1.0f;   // w = z
        clip[3][2] = nearM;   // depth = near / z
    } else {
        clip[2][2] = 1.0f / (farM - nearM);
        clip[3][2] = farM / (farM - nearM);
        clip[3] = glm::vec4(shift, clip[3][2], 1.0f);
    }
    return clip;
}

glm::vec3 View::position() const { return glm::vec3(glm::affineInverse(worldToView)[3]); }

glm::vec3 View::forward() const { return -glm::vec3(worldToView[0][2], worldToView[1][2], worldToView[2][2]); }

double View::extent() const {
    const double x = halfExtent.x, y = halfExtent.y;
    // Solid angle of a rectangle seen from above its centre.
    return perspective ? 4.0 * std::atan(x * y / std::sqrt(1.0 + x * x + y * y)) : 4.0 * x * y;
}

glm::mat4 lookAlong(const glm::vec3& position, const glm::vec3& forward, const glm::vec3& up) {
    glm::vec3 side = glm::cross(forward, up);
    if (glm::dot(side, side) < 1e-8f) {
        side = glm::cross(forward, std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0));
    }
    const glm::vec3 x = glm::normalize(side), y = glm::cross(x, forward);
    glm::mat4 view(1.0f);
    for (int i = 0; i < 3; ++i) {
        view[i][0] = x[i];
        view[i][1] = y[i];
        view[i][2] = -forward[i];
    }
    view[3] = glm::vec4(-glm::dot(x, position), -glm::dot(y, position), glm::dot(forward, position), 1.0f);
    return view;
}

int viewsFlag(std::initializer_list<const View*> views) {
    const auto perspective = [](const View* view) { return view->perspective; };
    if (std::all_of(views.begin(), views.end(), perspective)) return 1;
    return std::none_of(views.begin(), views.end(), perspective) ? 2 : 0;
}

void setView(const gl::Uniforms& uniforms, const char* name, const View& view) {
    const std::string prefix = std::string(name) + ".";
    uniforms.set((prefix + "worldToView").c_str(), view.worldToView)
        .set((prefix + "halfExtent").c_str(), view.halfExtent)
        .set((prefix + "near").c_str(), view.nearM)
        .set((prefix + "far").c_str(), view.farM)
        .set((prefix + "perspective").c_str(), view.perspective);
}

}  // namespace caustream::render
