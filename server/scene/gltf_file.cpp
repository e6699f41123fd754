#include "scene/gltf_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <string_view>

namespace caustream::scene {

namespace {

constexpr std::array<std::string_view, 9> kSupportedExtensions{
    "KHR_lights_punctual",  "KHR_materials_dispersion",   "KHR_materials_emissive_strength",
    "KHR_materials_ior",    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_volume", "KHR_mesh_quantization",      "KHR_texture_transform"};

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

// Every way to the file system ends here; `user` is the name of the first file asked for.
bool refuseExists(const std::string& path, void* user) {
    auto& asked = *static_cast<std::string*>(user);
    if (asked.empty()) asked = path;
    return false;
}
std::string keepPath(const std::string& path, void*) {
    return path;
}
bool refuseRead(std::vector<unsigned char>*, std::string*, const std::string& path, void* user) {
    return refuseExists(path, user);
}
bool refuseWrite(std::string*, const std::string& path, const std::vector<unsigned char>&, void* user) {
    return refuseExists(path, user);
}

// Images of buffer views come with an unchecked pointer, which is not touched: they are found again by their view.
bool keepEncoded(tinygltf::Image* image, int index, std::string*, std::string*, int, int, const unsigned char* bytes,
                 int size, void* user) {
    if (image->bufferView == -1 && size > 0)
        static_cast<GltfFile*>(user)->inlineImages[index].assign(bytes, bytes + size);
    return true;
}

std::string firstLine(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

// A name is copied for every object, warning and error that it is in.
template <class Named>
void shortenNames(std::vector<Named>& list) {
    constexpr std::size_t kMaxNameBytes = 64;
    for (Named& one : list) cutText(one.name, kMaxNameBytes);
}

}  // namespace

tl::expected<GltfFile, LoadError> parseGltf(std::span<const std::byte> glb) {
    GltfFile file;
    std::string error, warning, asked;
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks({refuseExists, keepPath, refuseRead, refuseWrite, &asked});
    reader.SetImageLoader(keepEncoded, &file);
    bool parsed = false;
    try {
        parsed = reader.LoadBinaryFromMemory(&file.model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(glb.data()),
                                             static_cast<unsigned int>(glb.size()));
    } catch (const std::exception& thrown) {
        error = thrown.what();
    }
    if (!asked.empty()) return fail("the file refers to \"" + asked + "\" outside itself, which is never opened");
    if (!parsed) return fail("the glTF cannot be read: " + firstLine(error.empty() ? "unknown structure" : error));
    for (const std::string& required : file.model.extensionsRequired)
        if (std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), required) == kSupportedExtensions.end())
            return fail("the file requires the extension " + required + ", which is not supported");
    for (std::size_t i = 0; i < file.model.images.size(); ++i)
        if (!file.model.images[i].uri.empty())
            return fail("image " + std::to_string(i) + " refers to \"" + file.model.images[i].uri +
                        "\" outside the file, which is never opened");
    shortenNames(file.model.meshes);
    shortenNames(file.model.nodes);
    shortenNames(file.model.materials);
    shortenNames(file.model.lights);
    shortenNames(file.model.cameras);
    return file;
}

void cutText(std::string& text, std::size_t maxBytes) {
    if (text.size() <= maxBytes) return;
    while (maxBytes > 0 && (static_cast<unsigned char>(text[maxBytes]) & 0xC0) == 0x80) --maxBytes;
    text.resize(maxBytes);
}

tl::expected<std::span<const std::uint8_t>, LoadError> viewBytes(const tinygltf::Model& model, int view,
                                                                 const std::string& what) {
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
        return fail(what + " names buffer view " + std::to_string(view) + ", which is not there");
    const tinygltf::BufferView& v = model.bufferViews[view];
    if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= model.buffers.size())
        return fail("buffer view " + std::to_string(view) + " names buffer " + std::to_string(v.buffer) +
                    ", which is not there");
    const std::vector<unsigned char>& data = model.buffers[v.buffer].data;
    if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
        return fail("buffer view " + std::to_string(view) + " reaches " + std::to_string(v.byteLength) +
                    " bytes from " + std::to_string(v.byteOffset) + " into a buffer of " + std::to_string(data.size()));
    return std::span(data).subspan(v.byteOffset, v.byteLength);
}

const tinygltf::Value* member(const tinygltf::Value& object, const std::string& key) {
    return object.IsObject() && object.Has(key) ? &object.Get(key) : nullptr;
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double numberOr(const tinygltf::Value* value, double fallback) {
    if (!value || !value->IsNumber()) return fallback;
    const double number = value->GetNumberAsDouble();
    return std::isfinite(number) ? number : fallback;
}

std::vector<double> numbers(const tinygltf::Value* value) {
    std::vector<double> result;
    if (!value || !value->IsArray()) return result;
    for (std::size_t i = 0; i < value->ArrayLen(); ++i) {
        const tinygltf::Value& item = value->Get(static_cast<int>(i));
        if (!item.IsNumber() || !std::isfinite(item.GetNumberAsDouble())) return {};
        result.push_back(item.GetNumberAsDouble());
    }
    return result;
}

}  // namespace caustream::scene
