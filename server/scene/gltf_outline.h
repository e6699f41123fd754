// How many of everything the JSON of a GLB lists, before the glTF library makes a struct of hundreds of bytes for each.
#pragma once
#include <string_view>
#include <tl/expected.hpp>

#include "scene/gltf_loader.h"

namespace caustream::scene {

// `json` is shallow and has a bounded number of values (checkContainer). Errors name the list that is too long, and a
// buffer that would be another copy of the binary chunk.
tl::expected<void, LoadError> checkOutline(std::string_view json);

}  // namespace caustream::scene
