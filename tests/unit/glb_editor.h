// GLB files for the loader's tests: made from JSON and bytes, taken apart, changed, put together again.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_loader.h"

namespace caustream::test {

using nlohmann::json;

struct Glb {
    json root;
    std::vector<std::uint8_t> binary;

    // Both return the new thing's index. `stride` 0: tightly packed.
    template <class T>
    int view(const std::vector<T>& values, int stride = 0) {
        return viewOf(values.data(), values.size() * sizeof(T), stride);
    }
    int accessor(int view, int componentType, std::size_t count, const char* type, std::size_t byteOffset = 0);

    std::vector<std::uint8_t> pack() const;

 private:
    int viewOf(const void* data, std::size_t bytes, int stride);
};

Glb unpack(std::span<const std::uint8_t> file);
std::vector<std::uint8_t> packText(std::string text, const std::vector<std::uint8_t>& binary);

// One triangle in the plane y = 0, facing up, without normals, uv, indices, material; one node, one scene.
Glb triangle();
// A closed tetrahedron of glass with 16-bit indices, outside out.
Glb glassTetrahedron();

tl::expected<scene::Scene, scene::LoadError> load(std::span<const std::uint8_t> file,
                                                  const scene::LoadLimits& limits = {});
tl::expected<scene::Scene, scene::LoadError> load(const Glb& glb);

// Whether any warning holds `part`.
bool warns(const scene::Scene& scene, const std::string& part);

}  // namespace caustream::test
