// Small scenes made in code, for tests of single passes.
#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace caustream::tests {

class SyntheticScene {
   public:
    int material(const scene::Material& made) {
        materials.push_back(made);
        return static_cast<int>(materials.size()) - 1;
    }

    // One object of triangles; `corners` three by three, counter-clockwise seen from outside, flat normals.
    void addFlat(int materialIndex, const std::vector<glm::vec3>& corners) {
        begin(materialIndex);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const glm::vec3 normal = glm::normalize(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]));
            for (std::size_t k = 0; k < 3; ++k) push(corners[i + k], normal);
        }
        end();
    }

    // Parallelogram from `corner` along `a` and `b`; its outside is that of cross(a, b). uv 0..1 along a and b.
    void addQuad(int materialIndex, const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
        begin(materialIndex);
        const glm::vec3 normal = glm::normalize(glm::cross(a, b));
        const glm::vec2 uvs[] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
        for (const glm::vec2& uv : uvs) push(corner + uv.x * a + uv.y * b, normal, uv);
        end();
    }

    void addBox(int materialIndex, const glm::vec3& low, const glm::vec3& high) {
        std::vector<glm::vec3> corners;
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = 0; side < 2; ++side) {
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                glm::vec3 p[4];
                for (int k = 0; k < 4; ++k) {
                    p[k][axis] = side ? high[axis] : low[axis];
                    p[k][u] = (k == 1 || k == 2) ? high[u] : low[u];
                    p[k][v] = k >= 2 ? high[v] : low[v];
                }
                const int order[2][6] = {{0, 2, 1, 0, 3, 2}, {0, 1, 2, 0, 2, 3}};
                for (const int k : order[side]) corners.push_back(p[k]);
            }
        }
        addFlat(materialIndex, corners);
    }

    // Latitudes and longitudes, smooth normals.
    void addSphere(int materialIndex, const glm::vec3& centre, float radius, int rings = 48) {
        begin(materialIndex);
        const auto at = [&](int ring, int segment) {
            const float theta = glm::pi<float>() * float(ring) / float(rings);
            const float phi = glm::pi<float>() * float(segment) / float(rings);
            return glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
        };
        for (int ring = 0; ring < rings; ++ring) {
            for (int segment = 0; segment < 2 * rings; ++segment) {
                const glm::vec3 n[] = {at(ring, segment), at(ring + 1, segment), at(ring + 1, segment + 1),
                                       at(ring, segment), at(ring + 1, segment + 1), at(ring, segment + 1)};
                for (const glm::vec3& normal : n) push(centre + radius * normal, normal);
            }
        }
        end();
    }

    std::shared_ptr<const scene::Geometry> geometry() const { return std::make_shared<scene::Geometry>(geometry_); }
    scene::Geometry& edit() { return geometry_; }

    std::vector<scene::Material> materials;

   private:
    void begin(int materialIndex) {
        scene::Object object;
        object.name = "object " + std::to_string(geometry_.objects.size());
        object.material = materialIndex;
        object.firstIndex = static_cast<std::uint32_t>(geometry_.indices.size());
        geometry_.objects.push_back(object);
    }
    void push(const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv = glm::vec2(0.0f)) {
        geometry_.indices.push_back(static_cast<std::uint32_t>(geometry_.vertices.size()));
        geometry_.vertices.push_back({position, normal, uv});
        scene::Bounds& bounds = geometry_.objects.back().bounds;
        bounds.min = glm::min(bounds.min, position);
        bounds.max = glm::max(bounds.max, position);
    }
    void end() {
        scene::Object& object = geometry_.objects.back();
        object.indexCount = static_cast<std::uint32_t>(geometry_.indices.size()) - object.firstIndex;
        geometry_.bounds.min = glm::min(geometry_.bounds.min, object.bounds.min);
        geometry_.bounds.max = glm::max(geometry_.bounds.max, object.bounds.max);
    }

    scene::Geometry geometry_;
};

}  // namespace caustream::tests
