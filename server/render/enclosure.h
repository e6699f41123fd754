// Which receivers can stand between a light and anything else. The walls and the floor of a room cannot: the whole scene
// lies on one side of them, and so does the light.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace caustream::render {

class Enclosure {
   public:
    explicit Enclosure(const scene::Geometry& geometry);

    // Whether the object, as a receiver, may shade something; true where that is not clear.
    bool shades(const scene::Object& object, const scene::Light& light) const;

   private:
    // The plane that an object lies in, and how far the scene's parts reach from it to either side, m.
    struct Plane {
        bool flat = false;
        glm::vec3 point{0.0f}, normal{0.0f};
        float low = 0.0f, high = 0.0f;
    };

    const scene::Object* first_;     // of Geometry::objects, which outlives this
    float tolerance_;                // m
    std::vector<Plane> planes_;      // by object
};

}  // namespace caustream::render
