// Which light throws the caustic, and the lights as the camera's passes see them.
#pragma once
#include <optional>

#include "render/coarse_trace.h"
#include "render/lighting.h"
#include "scene/scene.h"

namespace caustream::render {

// Index of the light that is strongest at the casters (at the scene's centre when there is none).
int keyLight(const scene::Scene& scene);

// Key light first; colours, reference irradiance and environment filled in, shadow and maps not. `landing` is where the
// key light's caustic lies, if known: the picture is exposed for it.
Lighting makeLighting(const scene::Scene& scene, int key, const std::optional<glm::vec3>& landing);

}  // namespace caustream::render
