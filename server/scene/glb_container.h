// The first look at a GLB: its chunks and the shape of its JSON, before any library touches it.
#pragma once
#include <cstddef>
#include <span>
#include <tl/expected.hpp>

#include "scene/gltf_loader.h"

namespace caustream::scene {

// Header, chunk lengths, and JSON that is shallow and small enough to be parsed into memory a few hundred times its
// size per value. `bytes` up to limits.bytes.
tl::expected<void, LoadError> checkContainer(std::span<const std::byte> glb, const LoadLimits& limits);

}  // namespace caustream::scene
