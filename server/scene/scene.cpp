#include "scene/scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace caustream::scene {

float Bounds::radius() const {
    return empty() ? 0.0f : 0.5f * glm::distance(min, max);
}

void Bounds::add(const glm::vec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
}

void Bounds::add(const Bounds& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
}

}  // namespace caustream::scene
