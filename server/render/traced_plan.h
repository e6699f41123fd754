// The plan of traced transport.
#pragma once
#include "render/plan.h"

namespace caustream::render {

RenderPlan makeTracedPlan(const PlanFacts& facts, const Request& request);

}  // namespace caustream::render
