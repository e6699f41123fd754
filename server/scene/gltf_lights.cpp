#include "scene/gltf_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace caustream::scene {

namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr float kMaxIntensity = 1e12f;  // cd or lx: beyond it half the arithmetic of a frame overflows

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

glm::vec3 unitOr(const glm::dvec3& v, const glm::vec3& fallback) {
    const double length = glm::length(v);
    return std::isfinite(length) && length > 0.0 ? glm::vec3(v / length) : fallback;
}

}  // namespace

tl::expected<Light, LoadError> readLight(const tinygltf::Light& source, const glm::dmat4& world, TextureTable& textures,
                                         const std::string& name) {
    const std::string what = "light \"" + name + "\"";
    Light light;
    light.name = name;
    light.position = glm::vec3(world[3]);
    light.direction = unitOr(-glm::dvec3(world[2]), light.direction);  // glTF: along -Z of the node

    if (source.type == "spot")
        light.type = LightType::Spot;
    else if (source.type == "point")
        light.type = LightType::Point;
    else if (source.type == "directional")
        light.type = LightType::Directional;
    else
        return fail(what + " has the unknown type \"" + source.type + "\"");

    if (light.type == LightType::Spot) {
        light.innerConeDeg = static_cast<float>(source.spot.innerConeAngle * kDegPerRad);
        light.outerConeDeg = static_cast<float>(source.spot.outerConeAngle * kDegPerRad);
        if (!(light.outerConeDeg > 0.0f && light.outerConeDeg <= 90.001f && light.innerConeDeg >= 0.0f &&
              light.innerConeDeg <= light.outerConeDeg))
            return fail(what + " needs 0 <= innerConeAngle <= outerConeAngle <= pi/2, outerConeAngle above 0");
    }
    light.intensity = static_cast<float>(source.intensity);
    if (!(light.intensity >= 0.0f && light.intensity <= kMaxIntensity))
        return fail(what + " has an intensity outside 0..1e12");
    if (source.color.size() == 3) light.color = glm::vec3(source.color[0], source.color[1], source.color[2]);
    for (int c = 0; c < 3; ++c)
        if (!(light.color[c] >= 0.0f && light.color[c] <= 1e6f))
            return fail(what + " has a colour that makes no sense");

    if (const tinygltf::Value* own = member(source.extras, "caustream")) {
        if (const tinygltf::Value* spectrum = member(*own, "spectrum")) {
            auto read = readSpectrum(*spectrum, what);
            if (!read) return tl::unexpected(read.error());
            light.spectrum = std::move(*read);
        }
        if (const tinygltf::Value* cookie = member(*own, "cookie")) {
            const auto texture = textures.use(static_cast<int>(numberOr(cookie, -1.0)), what + "'s cookie");
            if (!texture) return tl::unexpected(texture.error());
            light.cookie = *texture;
        }
    }
    return light;
}

Camera readCamera(const tinygltf::Camera& source, const tinygltf::Node& node, const glm::dmat4& world,
                  const Bounds& subject, const std::string& name, std::vector<std::string>& warnings) {
    Camera camera;
    camera.name = name;
    camera.eye = glm::vec3(world[3]);
    camera.up = unitOr(glm::dvec3(world[1]), camera.up);
    const glm::vec3 forward = unitOr(-glm::dvec3(world[2]), glm::vec3(0, 0, -1));

    // The point to orbit around: on the axis, as far as what the scene is about.
    float distance = glm::dot(subject.centre() - camera.eye, forward);
    if (!(distance > 0.0f)) distance = std::max(subject.radius(), 1.0f);
    camera.target = camera.eye + distance * forward;
    if (const tinygltf::Value* own = member(node.extras, "caustream"))
        if (const std::vector<double> target = numbers(member(*own, "target")); target.size() == 3)
            camera.target = glm::vec3(target[0], target[1], target[2]);

    if (source.type == "perspective" && source.perspective.yfov > 0.0 && source.perspective.yfov < std::numbers::pi)
        camera.fovYDeg = std::clamp(static_cast<float>(source.perspective.yfov * kDegPerRad), 1.0f, 170.0f);
    else
        warnings.push_back("camera \"" + name + "\" is not a perspective one; it is shown with 40 degrees");
    return camera;
}

}  // namespace caustream::scene
