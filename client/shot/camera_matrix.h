// Where a pixel of a picture looks: what a data set needs to make points of depths.
#pragma once
#include "protocol/state.h"

namespace caustream::shot {

// Of a resolved document's `camera` and `stream`: {"world_to_camera": 4 rows of 4, "fx", "fy", "cx", "cy"}. Camera space is
// OpenGL's: x to the right, y up, looking along -z. A point x, y, z of it is seen at cx + fx x / -z, cy - fy y / -z in pixels
// from the upper left corner, its depth is -z.
protocol::Json cameraMatrix(const protocol::Json& resolved);

}  // namespace caustream::shot
