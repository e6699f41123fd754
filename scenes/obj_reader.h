// Wavefront OBJ: positions and triangles, nothing else.
#pragma once
#include <string>

#include "scenes/mesh.h"

namespace caustream::scenes {

// Throws std::runtime_error that names the file and line.
Mesh readObj(const std::string& path);

}  // namespace caustream::scenes
