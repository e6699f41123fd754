// A scene file's lights, materials and surroundings with a state document's values in their place, and back.
#pragma once
#include <tl/expected.hpp>

#include "protocol/messages.h"
#include "scene/scene.h"

namespace caustream::session {

// Errors: a light or material the scene does not have, a texture it does not have, a unit that does not fit the light.
// ["W", v] becomes candela over the light's own solid angle at 683 lm/W, as glTF exporters do.
tl::expected<scene::Scene, protocol::DecodeError> withOverrides(const scene::Scene& base, const protocol::State& state);

// The camera the document asks for; what it leaves out is the scene's first. Errors: no direction to look in.
tl::expected<scene::Camera, protocol::DecodeError> cameraOf(const scene::Scene& scene, const protocol::State& state);

}  // namespace caustream::session
