#include "scene/primitive_reader.h"

#include <cmath>
#include <numeric>

#include "scene/accessor_reader.h"

namespace caustream::scene {

namespace {

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

// glTF 2.0, section 3.7.2.1: the order that keeps every triangle's winding.
std::vector<std::uint32_t> triangleList(std::vector<std::uint32_t> in, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        in.resize(in.size() / 3 * 3);
        return in;
    }
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i + 2 < in.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
    }
    return out;
}

}  // namespace

tl::expected<TriangleSoup, LoadError> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                    const UvSource& uv, std::size_t& budget, const std::string& what) {
    TriangleSoup soup;
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) return soup;

    // positions
    const int positionAccessor = attribute(primitive, "POSITION");
    if (positionAccessor < 0) return fail(what + " has no POSITION");
    auto positions = readVec3(model, positionAccessor, budget, what + "'s POSITION");
    if (!positions) return tl::unexpected(positions.error());
    soup.positions = std::move(*positions);
    budget -= soup.positions.size();
    for (const glm::dvec3& p : soup.positions)
        if (!finite(p))
            return fail("accessor " + std::to_string(positionAccessor) + " (" + what +
                        "'s POSITION) holds NaN or infinity");

    // normals and texture coordinates
    if (const int accessor = attribute(primitive, "NORMAL"); accessor >= 0) {
        auto normals = readVec3(model, accessor, soup.positions.size(), what + "'s NORMAL");
        if (!normals) return tl::unexpected(normals.error());
        soup.normals = std::move(*normals);
        if (soup.normals.size() != soup.positions.size()) return fail(what + " has fewer normals than positions");
    }
    if (const int accessor = attribute(primitive, "TEXCOORD_" + std::to_string(uv.set)); accessor >= 0) {
        auto uvs = readVec2(model, accessor, soup.positions.size(), what + "'s TEXCOORD");
        if (!uvs) return tl::unexpected(uvs.error());
        soup.uvs = std::move(*uvs);
        if (soup.uvs.size() != soup.positions.size())
            return fail(what + " has fewer texture coordinates than positions");
        for (glm::dvec2& p : soup.uvs) p = glm::dvec2(uv.transform * glm::dvec3(p, 1.0));
    }

    // triangles
    std::vector<std::uint32_t> order(soup.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    if (primitive.indices >= 0) {
        auto indices = readIndices(model, primitive.indices, budget);
        if (!indices) return tl::unexpected(indices.error());
        order = std::move(*indices);
        budget -= order.size();
    }
    for (std::uint32_t index : order)
        if (index >= soup.positions.size())
            return fail("accessor " + std::to_string(primitive.indices) + " (indices) holds " + std::to_string(index) +
                        ", but " + what + " has " + std::to_string(soup.positions.size()) + " vertices");
    soup.indices = triangleList(std::move(order), primitive.mode);
    return soup;
}

}  // namespace caustream::scene
