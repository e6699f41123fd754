#include "scene/accessor_reader.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "scene/gltf_file.h"

namespace caustream::scene {

namespace {

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

template <class T>
double load(const std::uint8_t* bytes, double scale) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return scale == 0.0 ? static_cast<double>(value) : std::max(static_cast<double>(value) / scale, -1.0);
}

// One component; normalised integers become 0..1 or -1..1.
double component(const std::uint8_t* bytes, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return load<std::int8_t>(bytes, normalized ? 127.0 : 0.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(bytes, normalized ? 255.0 : 0.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return load<std::int16_t>(bytes, normalized ? 32767.0 : 0.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes, normalized ? 65535.0 : 0.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<std::uint32_t>(bytes, 0.0);
        default:
            return load<float>(bytes, 0.0);
    }
}

std::size_t componentBytes(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

struct Strided {
    std::span<const std::uint8_t> bytes;
    std::size_t stride = 0;
    const std::uint8_t* at(std::size_t i) const { return bytes.data() + i * stride; }
};

// `count` elements of `elementBytes` from `offset` into a view: the last one's last byte must be inside.
tl::expected<Strided, LoadError> strided(const tinygltf::Model& model, int view, std::size_t offset, std::size_t count,
                                         std::size_t elementBytes, const std::string& name) {
    auto bytes = viewBytes(model, view, name);
    if (!bytes) return tl::unexpected(bytes.error());
    std::size_t stride = model.bufferViews[view].byteStride;
    if (stride == 0) stride = elementBytes;
    if (stride < elementBytes) return fail(name + " has a stride shorter than its elements");
    if (offset > bytes->size()) return fail(name + " begins outside its buffer view");
    const std::size_t room = bytes->size() - offset;
    if (room < elementBytes || (room - elementBytes) / stride < count - 1)
        return fail(name + " has " + std::to_string(count) + " elements, which do not fit its buffer view");
    return Strided{bytes->subspan(offset), stride};
}

}  // namespace

tl::expected<std::vector<double>, LoadError> readAccessor(const tinygltf::Model& model, int accessor, int components,
                                                          std::size_t maxCount, const std::string& what) {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size())
        return fail(what + " names accessor " + std::to_string(accessor) + ", which is not there");
    const tinygltf::Accessor& a = model.accessors[accessor];
    const std::string name = "accessor " + std::to_string(accessor) + " (" + what + ")";
    const std::size_t size = componentBytes(a.componentType);
    if (size == 0) return fail(name + " has an unknown component type");
    if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)) != components)
        return fail(name + " does not have " + std::to_string(components) + " components an element");
    if (a.count == 0) return fail(name + " is empty");
    if (a.count > maxCount)
        return fail(name + " has " + std::to_string(a.count) + " elements; " + std::to_string(maxCount) +
                    " are allowed");

    const std::size_t elementBytes = size * components;
    std::vector<double> values;
    if (a.bufferView >= 0) {
        const auto source = strided(model, a.bufferView, a.byteOffset, a.count, elementBytes, name);
        if (!source) return tl::unexpected(source.error());
        values.resize(a.count * components);
        for (std::size_t i = 0; i < a.count; ++i)
            for (int k = 0; k < components; ++k)
                values[i * components + k] = component(source->at(i) + k * size, a.componentType, a.normalized);
    } else {
        values.resize(a.count * components, 0.0);
    }
    if (!a.sparse.isSparse) return values;

    const auto& sparse = a.sparse;
    const std::size_t indexBytes = componentBytes(sparse.indices.componentType);
    if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > a.count || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0 || indexBytes == 0)
        return fail(name + " has sparse values that make no sense");
    const auto indices = strided(model, sparse.indices.bufferView, sparse.indices.byteOffset, sparse.count, indexBytes,
                                 name + "'s sparse indices");
    if (!indices) return tl::unexpected(indices.error());
    const auto replaced = strided(model, sparse.values.bufferView, sparse.values.byteOffset, sparse.count, elementBytes,
                                  name + "'s sparse values");
    if (!replaced) return tl::unexpected(replaced.error());
    for (int i = 0; i < sparse.count; ++i) {
        const double index = component(indices->at(i), sparse.indices.componentType, false);
        if (!(index >= 0.0 && index < static_cast<double>(a.count)))
            return fail(name + " has a sparse index outside it");
        for (int k = 0; k < components; ++k)
            values[static_cast<std::size_t>(index) * components + k] =
                component(replaced->at(i) + k * size, a.componentType, a.normalized);
    }
    return values;
}

tl::expected<std::vector<glm::dvec3>, LoadError> readVec3(const tinygltf::Model& model, int accessor,
                                                          std::size_t maxCount, const std::string& what) {
    const auto values = readAccessor(model, accessor, 3, maxCount, what);
    if (!values) return tl::unexpected(values.error());
    std::vector<glm::dvec3> result(values->size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = {(*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2]};
    return result;
}

tl::expected<std::vector<glm::dvec2>, LoadError> readVec2(const tinygltf::Model& model, int accessor,
                                                          std::size_t maxCount, const std::string& what) {
    const auto values = readAccessor(model, accessor, 2, maxCount, what);
    if (!values) return tl::unexpected(values.error());
    std::vector<glm::dvec2> result(values->size() / 2);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = {(*values)[2 * i], (*values)[2 * i + 1]};
    return result;
}

tl::expected<std::vector<std::uint32_t>, LoadError> readIndices(const tinygltf::Model& model, int accessor,
                                                                std::size_t maxCount) {
    if (accessor >= 0 && static_cast<std::size_t>(accessor) < model.accessors.size()) {
        const int type = model.accessors[accessor].componentType;
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
            type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            return fail("accessor " + std::to_string(accessor) + " (indices) is not of unsigned integers");
    }
    const auto values = readAccessor(model, accessor, 1, maxCount, "indices");
    if (!values) return tl::unexpected(values.error());
    std::vector<std::uint32_t> result(values->size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = static_cast<std::uint32_t>((*values)[i]);
    return result;
}

}  // namespace caustream::scene
