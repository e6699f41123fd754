// The scenes made at build time by scenes/ and embedded in the server.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "scene/gltf_loader.h"

namespace caustream::scene {

struct BuiltinScene {
    std::string_view name;       // "gem", "sphere"... the list of scenes/CMakeLists.txt
    std::string_view glb;
};
std::span<const BuiltinScene> builtinScenes();

// Loads one by name; the error lists the names there are.
tl::expected<Scene, LoadError> loadBuiltin(std::string_view name, const LoadObserver& observer = {});

}  // namespace caustream::scene
