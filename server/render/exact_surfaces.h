// The casters of a scene as traced transport meets them: convex solids as planes, all others as triangles in one
// hierarchy; the receivers in another. shaders/common/surfaces.glsl reads them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "gl/uniforms.h"
#include "scene/scene.h"

namespace caustream::render {

struct ExactCaster {
    std::size_t object = 0;   // index into Geometry::objects
    bool convex = false;      // traced as a set of planes
    int planes = 0;           // 0 for meshes
    std::string why;          // "24 planes, closed and convex", "69451 triangles, shaded with interpolated normals"
    bool mirror = false;
};

// Casters that refract and mirrors, in the order of the shader's caster numbers: highest priority first, then as in the
// file, so that the lowest number among those that hold a point is what is there. Without GL; any thread.
std::vector<ExactCaster> exactCasters(const scene::Scene& scene);

// GL thread.
class ExactSurfaces {
 public:
    static constexpr GLuint kUnits = 6;

    // Builds the casters' hierarchy; the receivers' is built when first bound. Throws Error when Embree does not start or
    // the triangles do not fit.
    explicit ExactSurfaces(const scene::Scene& scene);
    ~ExactSurfaces();

    const std::vector<ExactCaster>& casters() const { return casters_; }
    bool lone() const;          // a single caster, convex: what leaves it never comes back
    bool convexOnly() const;
    double buildMs() const { return buildMs_; }   // of all that was built so far

    // For ShaderLibrary::program: PLANES, MESHES, LONE, EXACT_RECEIVERS, each 0 or 1.
    std::vector<gl::Flag> flags(bool receivers = false) const;
    // Texture units firstUnit .. firstUnit + kUnits - 1 and the samplers' uniforms. `receivers` as in flags().
    void bind(const gl::Uniforms& uniforms, GLuint firstUnit, bool receivers = false) const;

 private:
    struct Hierarchy;
    std::shared_ptr<const scene::Geometry> geometry_;
    std::vector<std::size_t> receiverObjects_;
    std::vector<ExactCaster> casters_;
    float reachM_ = 0.0f;       // largest coordinate of a caster: what rounding is measured by
    gl::Buffer planes_;
    gl::BufferTexture planesView_;
    int planeTexels_ = 0;
    std::unique_ptr<Hierarchy> meshes_;
    mutable std::unique_ptr<Hierarchy> receivers_;
    mutable double buildMs_ = 0.0;
};

}  // namespace caustream::render
