// Cut stones as sets of planes (x, y, z: unit outward normal; w: offset), for convexPolyhedron. The girdle is at y = 0,
// the table up, the girdle's radius (or half length) 1.
#pragma once
#include <glm/vec4.hpp>
#include <vector>

namespace caustream::scenes {

// The round brilliant: table, 8 stars, 8 mains, 16 upper halves, 16 lower halves, 8 pavilion mains and a small culet, 58
// facets, and a thin girdle of 16 sides. Proportions of Tolkowsky 1919, Diamond Design: table .53 of the width, crown
// 34.5 degrees, pavilion 40.75.
std::vector<glm::dvec4> brilliantPlanes();

// An emerald cut: an oblong with cut corners, its crown and pavilion in three steps each, closed by a keel.
std::vector<glm::dvec4> emeraldPlanes();

}  // namespace caustream::scenes
