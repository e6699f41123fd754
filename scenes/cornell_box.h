// The setting most scenes share: a box 2 m wide, open to the camera, red on the left, green on the right.
#pragma once
#include "scenes/glb_writer.h"

namespace caustream::scenes {

// Floor at y = 0, x and z in -1..1 m; the camera looks in along -z.
void addCornellBox(GlbWriter& glb);

}  // namespace caustream::scenes
