// What a client is told of a scene: it holds no scene code, its sliders show this.
#pragma once
#include "protocol/messages.h"
#include "scene/scene.h"

namespace caustream::session {

protocol::SceneSummary summarize(const scene::Scene& scene);

// The document with the scene's own values where nothing overrides them. `resolved` and `camera` hold the overrides.
protocol::Json resolvedDocument(const protocol::State& state, const scene::Scene& resolved, const scene::Camera& camera);

protocol::Dispersion onTheWire(const optics::Dispersion& dispersion);

}  // namespace caustream::session
