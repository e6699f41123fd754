// GLB bytes -> Scene. The one way in, for the embedded scenes and for anyone's file.
#pragma once
#include <span>
#include <cstddef>
#include <string>
#include <tl/expected.hpp>

#include "scene/load_observer.h"
#include "scene/scene.h"

namespace caustream::scene {

struct LoadError {
    std::string message;  // one sentence that names the accessor, buffer view, extension... at fault
    bool cancelled = false;  // the observer ended it; nothing is wrong with the file
};

struct LoadLimits {
    std::size_t bytes = 64u << 20, triangles = 4'000'000, texels = 64u << 20;
    int casters = 16;
};

// `glb` is hostile until proven otherwise: every length is checked before it is used, nothing outside it is opened, and
// the memory taken is bounded by its size, whatever it claims.
tl::expected<Scene, LoadError> loadGlb(std::span<const std::byte> glb, const std::string& name,
                                       const LoadLimits& limits = {}, const LoadObserver& observer = {});

}  // namespace caustream::scene
