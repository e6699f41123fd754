#include "render/exact_surfaces.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>

#include "error.h"
#include "render/bvh.h"
#include "render/convex_planes.h"

namespace caustream::render {

namespace {

double nowMs() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A texture needs a texel even where nobody reads it.
template <class T>
gl::Buffer bufferOf(const std::vector<T>& texels, const char* label) {
    const T none{};
    return texels.empty() ? gl::Buffer(sizeof(T), &none, 0, label)
                          : gl::Buffer(texels.size() * sizeof(T), texels.data(), 0, label);
}

// An object's triangles, with the number that the shader calls it by.
struct Numbered {
    const scene::Object* object;
    float number;
};

}  // namespace

struct ExactSurfaces::Hierarchy {
    gl::Buffer nodes, corners, normals;
    gl::BufferTexture nodesView, cornersView, normalsView;
    int nodeCount = 0;
    glm::vec3 low{0.0f}, cellsPerM{1.0f};

    Hierarchy(const scene::Geometry& geometry, const std::vector<Numbered>& objects, bool withNormals) {
        std::vector<Triangle> triangles;
        std::vector<std::pair<std::uint32_t, float>> origins;   // first index, number
        for (const Numbered& each : objects) {
            for (std::uint32_t i = 0; i + 2 < each.object->indexCount; i += 3) {
                const std::uint32_t first = each.object->firstIndex + i;
                Triangle triangle;
                for (std::uint32_t k = 0; k < 3; ++k) triangle.corners[k] = geometry.vertices[geometry.indices[first + k]].position;
                triangles.push_back(triangle);
                origins.emplace_back(first, each.number);
            }
        }
        const Bvh bvh = buildBvh(triangles);
        GLint most = 0;
        glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
        if (3 * bvh.triangles.size() > static_cast<std::size_t>(most)) {
            throw Error("exact surfaces of " + std::to_string(bvh.triangles.size()) + " triangles do not fit this GPU's buffer textures of " +
                        std::to_string(most) + " texels; use transport.mode refined, or fewer triangles");
        }
        nodeCount = static_cast<int>(bvh.nodes.size());
        low = bvh.low;
        cellsPerM = bvh.cellsPerM;

        std::vector<glm::vec4> cornerTexels, normalTexels;
        cornerTexels.reserve(3 * bvh.triangles.size());
        for (const std::uint32_t triangle : bvh.triangles) {
            const auto [first, number] = origins[triangle];
            for (std::uint32_t k = 0; k < 3; ++k) {
                const scene::Vertex& vertex = geometry.vertices[geometry.indices[first + k]];
                cornerTexels.emplace_back(vertex.position, number);
                if (withNormals) normalTexels.emplace_back(vertex.normal, 0.0f);
            }
        }
        nodes = bufferOf(bvh.nodes, "hierarchy");
        corners = bufferOf(cornerTexels, "hierarchy corners");
        normals = bufferOf(normalTexels, "hierarchy normals");
        nodesView.view(nodes, GL_RGBA32UI);
        cornersView.view(corners, GL_RGBA32F);
        normalsView.view(normals, GL_RGBA32F);
    }
};

std::vector<ExactCaster> exactCasters(const scene::Scene& scene) {
    std::vector<ExactCaster> casters;
    const auto materialOf = [&](std::size_t object) -> const scene::Material& {
        return scene.materials[static_cast<std::size_t>(scene.geometry->objects[object].material)];
    };
    for (std::size_t i = 0; i < scene.geometry->objects.size(); ++i) {
        const scene::Material& material = materialOf(i);
        if (!(material.caster && !material.thinWalled) && !material.mirror) continue;
        const auto shape = convexShape(scene.geometry, i);
        casters.push_back({i, shape->convex(), static_cast<int>(shape->planes.size()), shape->why, material.mirror});
    }
    std::stable_sort(casters.begin(), casters.end(), [&](const ExactCaster& a, const ExactCaster& b) {
        return materialOf(a.object).priority > materialOf(b.object).priority;
    });
    return casters;
}

ExactSurfaces::ExactSurfaces(const scene::Scene& scene) : geometry_(scene.geometry), casters_(exactCasters(scene)) {
    const double start = nowMs();
    const auto& objects = geometry_->objects;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const scene::Material& material = scene.materials[static_cast<std::size_t>(objects[i].material)];
        if (!material.caster && !material.mirror) receiverObjects_.push_back(i);
    }

    // Two texels a caster (first plane, planes; a sphere around it), then the planes relative to the spheres' centres.
    std::vector<glm::vec4> texels(2 * casters_.size());
    std::vector<Numbered> meshes;
    for (std::size_t i = 0; i < casters_.size(); ++i) {
        const scene::Object& object = objects[casters_[i].object];
        const glm::vec3 centre = object.bounds.centre();
        const glm::vec3 far = glm::max(glm::abs(object.bounds.min), glm::abs(object.bounds.max));
        reachM_ = std::max({reachM_, far.x, far.y, far.z});
        texels[2 * i] = {static_cast<float>(texels.size()), static_cast<float>(casters_[i].planes), 0.0f, 0.0f};
        texels[2 * i + 1] = glm::vec4(centre, object.bounds.radius());
        if (!casters_[i].convex) {
            meshes.push_back({&object, static_cast<float>(i)});
            continue;
        }
        for (const glm::dvec4& plane : convexShape(geometry_, casters_[i].object)->planes) {
            texels.emplace_back(glm::vec3(plane), static_cast<float>(plane.w - glm::dot(glm::dvec3(plane), glm::dvec3(centre))));
        }
    }
    planeTexels_ = static_cast<int>(texels.size());
    planes_ = bufferOf(texels, "planes");
    planesView_.view(planes_, GL_RGBA32F);
    meshes_ = std::make_unique<Hierarchy>(*geometry_, meshes, true);
    buildMs_ = nowMs() - start;
}

ExactSurfaces::~ExactSurfaces() = default;

bool ExactSurfaces::convexOnly() const {
    return std::all_of(casters_.begin(), casters_.end(), [](const ExactCaster& caster) { return caster.convex; });
}

bool ExactSurfaces::lone() const { return casters_.size() == 1 && casters_[0].convex; }

std::vector<gl::Flag> ExactSurfaces::flags(bool receivers) const {
    const bool planes = std::any_of(casters_.begin(), casters_.end(), [](const ExactCaster& caster) { return caster.convex; });
    return {{"PLANES", planes ? 1 : 0}, {"MESHES", convexOnly() ? 0 : 1}, {"LONE", lone() ? 1 : 0},
            {"EXACT_RECEIVERS", receivers ? 1 : 0}};
}

void ExactSurfaces::bind(const gl::Uniforms& uniforms, GLuint firstUnit, bool receivers) const {
    if (receivers && !receivers_) {
        const double start = nowMs();
        std::vector<Numbered> objects;
        for (const std::size_t i : receiverObjects_) objects.push_back({&geometry_->objects[i], static_cast<float>(i)});
        receivers_ = std::make_unique<Hierarchy>(*geometry_, objects, false);
        buildMs_ += nowMs() - start;
    }
    const Hierarchy& ground = receivers ? *receivers_ : *meshes_;
    const GLuint textures[kUnits] = {planesView_.get(),          meshes_->nodesView.get(), meshes_->cornersView.get(),
                                     meshes_->normalsView.get(), ground.nodesView.get(),   ground.cornersView.get()};
    constexpr const char* kNames[kUnits] = {"u_planes", "u_meshNodes", "u_meshCorners", "u_meshNormals", "u_groundNodes", "u_groundCorners"};
    for (GLuint i = 0; i < kUnits; ++i) {
        glBindTextureUnit(firstUnit + i, textures[i]);
        uniforms.set(kNames[i], static_cast<int>(firstUnit + i));
    }
    uniforms.set("u_exactCasters", static_cast<int>(casters_.size()))
        .set("u_firstTriangle", planeTexels_)
        .set("u_exactReach", reachM_)
        .set("u_mesh.nodes", meshes_->nodeCount)
        .set("u_mesh.low", meshes_->low)
        .set("u_mesh.cellsPerM", meshes_->cellsPerM)
        .set("u_ground.nodes", ground.nodeCount)
        .set("u_ground.low", ground.low)
        .set("u_ground.cellsPerM", ground.cellsPerM);
}

}  // namespace caustream::render
