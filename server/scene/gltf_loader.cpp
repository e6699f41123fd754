#include "scene/gltf_loader.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "scene/fallbacks.h"
#include "scene/glb_container.h"
#include "scene/gltf_file.h"
#include "scene/gltf_lights.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_nodes.h"
#include "scene/mesh_cleaning.h"
#include "scene/primitive_reader.h"

namespace caustream::scene {

namespace {

tl::unexpected<LoadError> fail(std::string message) {
    return tl::unexpected(LoadError{std::move(message)});
}

using Status = tl::expected<void, LoadError>;

// A mesh may be placed many times, so that a small file unfolds: by how much is bounded by its own bytes. What no scene
// of that size comes near: 16 vertices and indices for each byte, and a hundred boxes for free.
constexpr std::size_t kElementsFree = 1u << 18, kElementsPerByte = 16;
constexpr std::size_t kElementsPerVisit = 8;  // of a primitive, be it empty
constexpr std::size_t kMaxObjects = 32'768, kMaxLights = 256, kMaxCameras = 256;  // all are named to every viewer
constexpr std::size_t kMaxWarnings = 64;
constexpr std::size_t kMaxErrorBytes = 300;
constexpr double kFarM = 1e9;      // lights and cameras, as in a state document
// Shares of the time it takes, roughly: the JSON, the pictures, and the rest for the meshes.
constexpr double kParsed = 0.1, kPictures = 0.3;

std::size_t elementBudget(std::size_t bytes, const LoadLimits& limits) {
    return std::min(6 * limits.triangles, kElementsFree + kElementsPerByte * bytes);
}

bool near(const glm::vec3& p) {
    return std::abs(p.x) <= kFarM && std::abs(p.y) <= kFarM && std::abs(p.z) <= kFarM;  // false for NaN
}

class Loader {
 public:
    Loader(GltfFile file, std::size_t fileBytes, const LoadLimits& limits, const LoadObserver& observer)
        : file_(std::move(file)),
          model_(file_.model),
          limits_(limits),
          observer_(observer),
          textures_(file_, limits.texels),
          budget_(elementBudget(fileBytes, limits)) {}

    tl::expected<Scene, LoadError> load(const std::string& name);

 private:
    Status readMaterials();
    Status readMeshes();
    Status readPart(const tinygltf::Mesh& mesh, const PlacedNode& node, std::map<int, Part>& parts);
    Status addObject(std::string name, int material, Part part);
    Status readLights();
    void readCameras();
    void addMissing();
    void limitMirrors();
    Status readSceneExtras();
    int defaultMaterial();
    void append(Object object, const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices);
    const Bounds& subject() const {
        return geometry_->casterBounds.empty() ? geometry_->bounds : geometry_->casterBounds;
    }
    void warn(std::string sentence) {
        if (scene_.warnings.size() < kMaxWarnings) scene_.warnings.push_back(std::move(sentence));
    }
    Status reached(double share) const;
    Status reachedMeshes() const;
    double elementsToRead() const;

    GltfFile file_;
    const tinygltf::Model& model_;
    LoadLimits limits_;
    const LoadObserver& observer_;
    TextureTable textures_;
    std::size_t budget_;  // vertices and indices that may still be read
    std::size_t budgetBefore_ = 0;  // readMeshes() began
    double toRead_ = 1.0;           // by it
    double cleaned_ = 0.0;          // of them, in parts that are objects now
    NameTable materialNames_, lightNames_, cameraNames_;
    std::vector<PlacedNode> nodes_;
    std::shared_ptr<Geometry> geometry_ = std::make_shared<Geometry>();
    Scene scene_;
    int defaultMaterial_ = -1, casters_ = 0;
};

Status Loader::reached(double share) const {
    if (!observer_ || observer_(std::min(share, 1.0))) return {};
    return tl::unexpected(LoadError{"reading was ended", true});
}

tl::expected<Scene, LoadError> Loader::load(const std::string& name) {
    scene_.name = name;
    if (auto ok = readMaterials(); !ok) return tl::unexpected(ok.error());
    auto nodes = placeNodes(model_);
    if (!nodes) return tl::unexpected(nodes.error());
    nodes_ = std::move(*nodes);
    if (auto ok = readMeshes(); !ok) return tl::unexpected(ok.error());
    limitMirrors();
    if (auto ok = readLights(); !ok) return tl::unexpected(ok.error());
    readCameras();
    addMissing();
    if (auto ok = readSceneExtras(); !ok) return tl::unexpected(ok.error());
    geometry_->textures = textures_.take();
    scene_.geometry = geometry_;
    return std::move(scene_);
}

Status Loader::readMaterials() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(model_.materials.size());
        if (auto ok = reached(kParsed + (kPictures - kParsed) * share); !ok) return ok;
        const std::string name = materialNames_.unique(model_.materials[i].name, "material", i);
        auto material = readMaterial(model_.materials[i], textures_, name, scene_.warnings);
        if (!material) return tl::unexpected(material.error());
        scene_.materials.push_back(std::move(*material));
    }
    return {};
}

// Vertices and indices of all that the nodes place, as the file announces them.
double Loader::elementsToRead() const {
    double elements = 1.0;
    const auto count = [&](int accessor) {
        return accessor >= 0 && static_cast<std::size_t>(accessor) < model_.accessors.size()
                   ? static_cast<double>(model_.accessors[static_cast<std::size_t>(accessor)].count)
                   : 0.0;
    };
    for (const PlacedNode& placed : nodes_) {
        const int mesh = model_.nodes[placed.index].mesh;
        if (mesh < 0 || static_cast<std::size_t>(mesh) >= model_.meshes.size()) continue;
        for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(mesh)].primitives) {
            const auto position = primitive.attributes.find("POSITION");
            elements += kElementsPerVisit + count(primitive.indices) +
                        (position == primitive.attributes.end() ? 0.0 : count(position->second));
            if (elements > static_cast<double>(budget_)) return static_cast<double>(budget_);  // it will end there
        }
    }
    return elements;
}

Status Loader::reachedMeshes() const {
    // To clean a mesh takes about as long as to read it.
    const double done = 0.5 * (static_cast<double>(budgetBefore_ - budget_) + cleaned_) / toRead_;
    return reached(kPictures + (1.0 - kPictures) * done);
}

Status Loader::readMeshes() {
    toRead_ = elementsToRead();
    budgetBefore_ = budget_;
    for (const PlacedNode& placed : nodes_) {
        const tinygltf::Node& node = model_.nodes[placed.index];
        if (node.mesh < 0) continue;
        if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
            return fail("node " + std::to_string(placed.index) + " names mesh " + std::to_string(node.mesh) +
                        ", which is not there");
        const tinygltf::Mesh& mesh = model_.meshes[node.mesh];
        std::map<int, Part> parts;  // by material
        if (auto ok = readPart(mesh, placed, parts); !ok) return ok;
        const std::string name = !node.name.empty() ? node.name : mesh.name;
        for (auto& [material, part] : parts)
            if (auto ok = addObject(name, material, std::move(part)); !ok) return ok;
    }
    if (geometry_->objects.empty()) return fail("the file has no mesh with triangles in its scene");
    return {};
}

Status Loader::readPart(const tinygltf::Mesh& mesh, const PlacedNode& placed, std::map<int, Part>& parts) {
    std::size_t withoutArea = 0;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const tinygltf::Primitive& primitive = mesh.primitives[i];
        const std::string what = "mesh \"" + mesh.name + "\" primitive " + std::to_string(i);
        if (primitive.material >= 0 && static_cast<std::size_t>(primitive.material) >= model_.materials.size())
            return fail(what + " names material " + std::to_string(primitive.material) + ", which is not there");
        const int material = primitive.material >= 0 ? primitive.material : defaultMaterial();
        if (budget_ < kElementsPerVisit) return fail("the file unfolds to more meshes than one of its size may");
        budget_ -= kElementsPerVisit;
        if (auto ok = reachedMeshes(); !ok) return ok;
        const UvSource uv = primitive.material >= 0 ? uvSource(model_.materials[primitive.material]) : UvSource{};
        const auto soup = readPrimitive(model_, primitive, uv, budget_, what);
        if (!soup) return tl::unexpected(soup.error());
        if (soup->indices.empty()) {
            warn(what + " has no triangles and is not shown");
            continue;
        }
        bool isNear = true;
        withoutArea += bake(*soup, placed.world, parts[material], isNear);
        if (!isNear) return fail(what + " lies beyond 1e8 m when its node places it");
    }
    if (withoutArea > 0)
        warn("mesh \"" + mesh.name + "\": " + std::to_string(withoutArea) + " triangles without area were left out");
    return {};
}

Status Loader::addObject(std::string name, int material, Part part) {
    const bool caster = scene_.materials[material].caster;
    const std::string what = "\"" + name + "\"";
    if (geometry_->objects.size() >= kMaxObjects) return fail("the file has more than " + std::to_string(kMaxObjects) + " objects");
    if (auto ok = reachedMeshes(); !ok) return ok;
    const double elements = static_cast<double>(part.vertices.size() + part.indices.size());
    if (caster) {
        if (const std::size_t dropped = dropDuplicates(part); dropped > 0)
            warn(what + ": " + std::to_string(dropped) + " triangles that are there twice were left out");
        cleaned_ += 0.5 * elements;
        if (auto ok = reachedMeshes(); !ok) return ok;
        const Topology topology = examine(part);
        if (topology.crowdedEdges > 0)
            warn(what + " has " + std::to_string(topology.crowdedEdges) +
                 " edges of more than two triangles; light may pass wrongly there");
        if (topology.openEdges > 0 && !scene_.materials[material].thinWalled)
            warn(what + " is not closed; light that meets the hole is lost");
        if (topology.closed && topology.volume < 0.0) {
            turnInsideOut(part);
            warn(what + " was inside out and has been turned");
        }
    }
    if (part.indices.empty()) return {};
    const std::size_t triangles = (geometry_->indices.size() + part.indices.size()) / 3;
    if (triangles > limits_.triangles)
        return fail("the file has more than " + std::to_string(limits_.triangles) + " triangles");

    Object object;
    object.name = std::move(name);
    object.material = material;
    append(std::move(object), part.vertices, part.indices);
    cleaned_ += caster ? 0.5 * elements : elements;
    if (auto ok = reachedMeshes(); !ok) return ok;
    casters_ += caster;
    if (casters_ > limits_.casters)
        return fail("the file has more than " + std::to_string(limits_.casters) +
                    " transmissive objects; join those of one material");
    return {};
}

void Loader::append(Object object, const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices) {
    const auto base = static_cast<std::uint32_t>(geometry_->vertices.size());
    object.firstIndex = static_cast<std::uint32_t>(geometry_->indices.size());
    object.indexCount = static_cast<std::uint32_t>(indices.size());
    geometry_->vertices.insert(geometry_->vertices.end(), vertices.begin(), vertices.end());
    for (std::uint32_t index : indices) {
        geometry_->indices.push_back(base + index);
        object.bounds.add(vertices[index].position);
    }
    geometry_->bounds.add(object.bounds);
    if (scene_.materials[object.material].caster) geometry_->casterBounds.add(object.bounds);
    geometry_->objects.push_back(std::move(object));
}

int Loader::defaultMaterial() {
    if (defaultMaterial_ < 0) {
        Material material;
        material.name = materialNames_.unique("", "material", scene_.materials.size());
        defaultMaterial_ = static_cast<int>(scene_.materials.size());
        scene_.materials.push_back(std::move(material));
    }
    return defaultMaterial_;
}

// Mirrors are casters in traced mode, and no file that was shown as receivers fails for having many.
void Loader::limitMirrors() {
    int casters = 0;
    for (const Object& o : geometry_->objects) casters += scene_.materials[o.material].caster || scene_.materials[o.material].mirror;
    if (casters <= limits_.casters) return;
    for (Material& material : scene_.materials) material.mirror = false;
    warn("the file has more than " + std::to_string(limits_.casters) +
         " transmissive and mirroring objects; its smooth metal throws no light");
}

Status Loader::readLights() {
    for (const PlacedNode& placed : nodes_) {
        const auto* link = extension(model_.nodes[placed.index].extensions, "KHR_lights_punctual");
        if (!link) continue;
        const double index = numberOr(member(*link, "light"), -1.0);
        if (!(index >= 0.0 && index < static_cast<double>(model_.lights.size())))
            return fail("node " + std::to_string(placed.index) + " names a light that is not there");
        if (scene_.lights.size() >= kMaxLights) return fail("the file places more than " + std::to_string(kMaxLights) + " lights");
        const tinygltf::Light& source = model_.lights[static_cast<std::size_t>(index)];
        const std::string name = lightNames_.unique(source.name, "light", scene_.lights.size());
        auto light = readLight(source, placed.world, textures_, name);
        if (!light) return tl::unexpected(light.error());
        if (!near(light->position)) return fail("light \"" + name + "\" lies beyond 1e9 m");
        if (light->type == LightType::Point)
            if (const glm::vec3 away = subject().centre() - light->position; glm::length(away) > 0.0f)
                light->direction = glm::normalize(away);
        scene_.lights.push_back(std::move(*light));
    }
    return {};
}

void Loader::readCameras() {
    for (const PlacedNode& placed : nodes_) {
        const tinygltf::Node& node = model_.nodes[placed.index];
        if (node.camera < 0 || static_cast<std::size_t>(node.camera) >= model_.cameras.size()) continue;
        const tinygltf::Camera& source = model_.cameras[node.camera];
        const std::string name = cameraNames_.unique(source.name, "camera", scene_.cameras.size());
        Camera camera = readCamera(source, node, placed.world, subject(), name, scene_.warnings);
        if (near(camera.eye) && near(camera.target) && camera.eye != camera.target && scene_.cameras.size() < kMaxCameras)
            scene_.cameras.push_back(std::move(camera));
        else
            warn("camera \"" + name + "\" lies beyond 1e9 m, or is one of too many, and is left out");
    }
}

void Loader::addMissing() {
    const Bounds about = subject();
    bool receiver = false;
    for (const Object& object : geometry_->objects) {
        const Material& material = scene_.materials[object.material];
        receiver = receiver || (!material.caster && !material.mirror);
    }
    if (!receiver) {
        Object floor;
        floor.name = "floor";
        Material material;
        material.name = materialNames_.unique("floor", "floor", scene_.materials.size());
        material.baseColor = glm::vec4(0.7f, 0.7f, 0.7f, 1.0f);
        floor.material = static_cast<int>(scene_.materials.size());
        scene_.materials.push_back(std::move(material));
        append(std::move(floor), placeFloor(about), {0, 1, 2, 0, 2, 3});
        warn("the file has nothing for light to land on; a floor was placed");
    }
    if (geometry_->casterBounds.empty()) warn("nothing in the file is transmissive, so there is no caustic");
    if (scene_.lights.empty()) {
        scene_.lights.push_back(placeLight(about, geometry_->bounds));
        warn("the file has no light; one was placed above");
    }
    if (scene_.cameras.empty()) {
        scene_.cameras.push_back(placeCamera(about));
        warn("the file has no camera; one was placed in front");
    }
}

Status Loader::readSceneExtras() {
    if (model_.scenes.empty()) return {};
    const int chosen = model_.defaultScene < 0 ? 0 : model_.defaultScene;
    const tinygltf::Value* own = member(model_.scenes[chosen].extras, "caustream");
    if (!own) return {};
    if (const tinygltf::Value* value = member(*own, "environment")) {
        const std::vector<double> color = numbers(value);
        if (color.size() != 3 || glm::min(glm::min(color[0], color[1]), color[2]) < 0.0)
            return fail("the scene's environment must be [r, g, b], none negative");
        scene_.environmentColor = glm::vec3(color[0], color[1], color[2]);
    }
    if (const tinygltf::Value* value = member(*own, "exposure_bias_ev")) {
        const double stops = numberOr(value, INFINITY);
        if (!(std::abs(stops) <= 16.0)) return fail("the scene's exposure_bias_ev must be within -16 to 16");
        scene_.exposureBiasEv = static_cast<float>(stops);
    }
    if (const tinygltf::Value* value = member(*own, "outside_index")) {
        const double index = numberOr(value, 0.0);
        if (!(index >= 1.0 && index <= 3.0)) return fail("the scene's outside_index must be within 1 to 3");
        scene_.outsideIndex = index;
    }
    return {};
}

}  // namespace

tl::expected<Scene, LoadError> loadGlb(std::span<const std::byte> glb, const std::string& name,
                                       const LoadLimits& limits, const LoadObserver& observer) {
    const auto read = [&]() -> tl::expected<Scene, LoadError> {
        if (auto ok = checkContainer(glb, limits); !ok) return tl::unexpected(ok.error());
        auto file = parseGltf(glb);
        if (!file) return tl::unexpected(file.error());
        return Loader(std::move(*file), glb.size(), limits, observer).load(name);
    };
    auto scene = read();
    if (!scene) {  // whatever the names that it tells hold, one line that can be shown
        cutText(scene.error().message, kMaxErrorBytes);
        for (char& c : scene.error().message)
            if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    return scene;
}

}  // namespace caustream::scene
