// KHR_lights_punctual and cameras at their nodes -> Light, Camera.
#pragma once
#include <glm/mat4x4.hpp>
#include <optional>

#include "scene/gltf_materials.h"

namespace caustream::scene {

// The light of a node; its `direction` for a point light is settled when the bounds are known (aimPointLights).
tl::expected<Light, LoadError> readLight(const tinygltf::Light& source, const glm::dmat4& world, TextureTable& textures,
                                         const std::string& name);

// The camera of a node; its target is extras.caustream.target, or settled later (nothing here) at the scene's distance.
Camera readCamera(const tinygltf::Camera& source, const tinygltf::Node& node, const glm::dmat4& world,
                  const Bounds& subject, const std::string& name, std::vector<std::string>& warnings);

}  // namespace caustream::scene
