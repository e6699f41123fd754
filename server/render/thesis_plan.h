// The plan of Mode::Thesis: the passes of the published algorithm, in its order.
#pragma once
#include "render/plan.h"

namespace caustream::render {

constexpr int kThesisGrid = 512;   // texels a side of the caster's image when none are asked for

RenderPlan makeThesisPlan(const PlanFacts& facts, const Request& request);

}  // namespace caustream::render
