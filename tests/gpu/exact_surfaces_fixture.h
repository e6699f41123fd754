// Rays through shaders/common/surfaces.glsl, and the same by looking at every triangle in double precision.
#pragma once
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>
#include <set>

#include "render/exact_surfaces.h"
#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/shader_folder.h"

namespace caustream::tests {

constexpr int kEmpty = 0x7fffffff;      // no caster

struct TestRay {
    glm::vec3 origin{0.0f};
    int from = -1;
    glm::vec3 direction{0, 0, 1};
    int inside = kEmpty;                // -2: not known
};

struct TestSurface {                    // as struct Surface, in texels
    float t;
    int caster, piece, unused;
    glm::vec4 point, geometric, shading;
};

struct Truth {
    double t = 1e300;
    int caster = -1;
    glm::dvec3 geometric{0.0}, shading{0.0};
    double edge = 1e300;                // of the barycentric coordinates, the one nearest 0
    double second = 1e300;              // t of the next that counts
};

inline scene::Scene sceneOf(const SyntheticScene& made) {
    scene::Scene scene;
    scene.geometry = made.geometry();
    scene.materials = made.materials;
    return scene;
}

// Nearest triangle of the casters, by Moeller & Trumbore 1997, among those that `inside` does not contradict.
inline Truth truthOf(const scene::Scene& scene, const std::vector<render::ExactCaster>& casters, const TestRay& ray) {
    Truth best;
    const glm::dvec3 origin(ray.origin), direction(ray.direction);
    for (std::size_t c = 0; c < casters.size(); ++c) {
        const scene::Object& object = scene.geometry->objects[casters[c].object];
        for (std::uint32_t i = 0; i + 2 < object.indexCount; i += 3) {
            const scene::Vertex* v[3];
            for (std::uint32_t k = 0; k < 3; ++k) v[k] = &scene.geometry->vertices[scene.geometry->indices[object.firstIndex + i + k]];
            const glm::dvec3 a(v[0]->position), ab = glm::dvec3(v[1]->position) - a, ac = glm::dvec3(v[2]->position) - a;
            const glm::dvec3 area = glm::cross(ab, ac), turned = glm::cross(a - origin, direction);
            const double along = glm::dot(direction, area);
            if (along == 0.0 || (ray.inside != -2 && (along < 0.0) == (ray.inside == static_cast<int>(c)))) continue;
            const double u = glm::dot(turned, ac) / along, w = -glm::dot(turned, ab) / along, t = glm::dot(a - origin, area) / along;
            const double edge = std::min({u, w, 1.0 - u - w});
            if (edge < 0.0 || t <= 0.0) continue;
            if (t >= best.t) {
                if (t > best.t + 1e-5) best.second = std::min(best.second, t);
                continue;
            }
            best.second = best.t;
            best.t = t;
            best.caster = static_cast<int>(c);
            best.edge = edge;
            best.geometric = glm::normalize(area);
            best.shading = glm::normalize((1.0 - u - w) * glm::dvec3(v[0]->normal) + u * glm::dvec3(v[1]->normal) + w * glm::dvec3(v[2]->normal));
            if (glm::dot(best.shading, direction) * along <= 0.0) best.shading = best.geometric;
        }
    }
    return best;
}

class ExactSurfacesTest : public CameraPass {
 protected:
    // Runs `work` (reads a and b, 4 floats each; writes texels of out_) once for each pair of inputs.
    std::vector<glm::vec4> compute(const render::ExactSurfaces& surfaces, const std::string& functions, const std::string& work,
                                   const std::vector<glm::vec4>& inputs, int texelsEach, bool receivers = false) {
        const ShaderFolder folder("caustream-exact-surfaces");
        folder.write("passes/walk.comp", "#include \"common/surfaces.glsl\"\n"
                     "layout(local_size_x = 64) in;\n"
                     "layout(std430, binding = 0) readonly buffer In { vec4 inputs[]; };\n"
                     "layout(std430, binding = 1) writeonly buffer Out { vec4 outputs[]; };\n"
                     "uniform int u_count;\n" + functions +
                     "void main() {\n    int i = int(gl_GlobalInvocationID.x);\n    if (i >= u_count) return;\n"
                     "    vec4 a = inputs[2 * i], b = inputs[2 * i + 1];\n" + work + "}\n");
        gl::ShaderLibrary library(folder.path());
        const GLuint program = library.program("walk", surfaces.flags(receivers));
        const gl::Uniforms uniforms(program);
        const std::size_t count = inputs.size() / 2;
        uniforms.set("u_count", static_cast<int>(count));
        surfaces.bind(uniforms, 2, receivers);
        const gl::Buffer in(inputs.size() * sizeof(glm::vec4), inputs.data(), 0, "in");
        const gl::Buffer out(static_cast<std::size_t>(texelsEach) * count * sizeof(glm::vec4), nullptr, 0, "out");
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.get());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.get());
        glUseProgram(program);
        glDispatchCompute(static_cast<GLuint>((count + 63) / 64), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // out -> read-back
        std::vector<glm::vec4> values(static_cast<std::size_t>(texelsEach) * count);
        glGetNamedBufferSubData(out.get(), 0, static_cast<GLsizeiptr>(out.bytes()), values.data());
        return values;
    }

    std::vector<TestSurface> nearest(const render::ExactSurfaces& surfaces, const std::vector<TestRay>& rays) {
        std::vector<glm::vec4> inputs;
        for (const TestRay& ray : rays) {
            inputs.emplace_back(ray.origin, static_cast<float>(ray.from));
            inputs.emplace_back(ray.direction, ray.inside == kEmpty ? -1.0f : static_cast<float>(ray.inside));
        }
        const auto values = compute(surfaces, "",
                                    "    ivec4 inside = b.w == -2.0 ? kAnywhere : ivec4(b.w < 0.0 ? 0x7fffffff : int(b.w), ivec3(0x7fffffff));\n"
                                    "    Surface s = nearestSurface(a.xyz, b.xyz, int(a.w), inside);\n"
                                    "    outputs[4 * i] = vec4(s.t, s.caster, s.piece, 0);\n"
                                    "    outputs[4 * i + 1] = vec4(s.point, 0);\n"
                                    "    outputs[4 * i + 2] = vec4(s.geometric, 0);\n    outputs[4 * i + 3] = vec4(s.shading, 0);\n",
                                    inputs, 4);
        std::vector<TestSurface> found;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::vec4& head = values[4 * i];
            found.push_back({head.x, static_cast<int>(head.y), static_cast<int>(head.z), 0, values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]});
        }
        return found;
    }
};

inline glm::vec3 randomUnit(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

}  // namespace caustream::tests
