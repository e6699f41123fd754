#include "client/shot/configure.h"

#include <fstream>
#include <iterator>

#include "protocol/patch.h"

namespace caustream::shot {
namespace {

using protocol::Json;

// Which way the frame travels: pictures for PNG unpacked, numbers as float, JPEG as the server made it.
Json streamPatch(const Options& options) {
    Json stream = {{"target", options.target}, {"width", options.width}, {"height", options.height}};
    const bool floats = options.kind == FileKind::Npy || options.kind == FileKind::Exr || options.target == "spectral";
    const bool jpeg = options.kind == FileKind::Jpeg && !floats;
    stream["encoding"] = jpeg ? "jpeg" : "raw";
    stream["sample"] = floats ? "f32" : "u8";
    if (jpeg) stream["quality"] = {"fixed", kShotJpegQuality};
    return {{"stream", stream}};
}

std::string namesOf(const Json& object) {
    std::string names;
    for (const auto& [name, value] : object.items()) names += (names.empty() ? "" : ", ") + name;
    return names.empty() ? "none" : names;
}

}  // namespace

connection::Options connectionTo(const Options& options) {
    connection::Options to{.address = options.address, .clientName = "caustream-shot", .strict = true};
    to.caFile = options.caFile;
    if (!options.token.empty()) to.token = options.token;
    return to;
}

bool isFile(const std::string& scene) {
    return scene.ends_with(".glb") || scene.find('/') != scene.npos;
}

tl::expected<std::vector<std::uint8_t>, Failure> readFile(const std::string& name) {
    std::ifstream in(name, std::ios::binary);
    if (!in) return tl::make_unexpected("cannot read " + name + "; check --scene");
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.empty()) return tl::make_unexpected(name + " is empty; --scene takes a GLB file");
    return bytes;
}

Session::Done configure(Session& session, const Options& options) {
    if (isFile(options.scene)) {
        auto bytes = readFile(options.scene);
        if (!bytes) return tl::make_unexpected(bytes.error());
        if (auto shown = session.showFile(std::move(*bytes)); !shown) return shown;
    } else if (!options.scene.empty()) {
        const Json patch = protocol::sceneChange({protocol::SceneRef::Kind::Builtin, options.scene});
        if (auto updated = session.update(patch); !updated) return updated;
        if (auto resolved = session.waitForScene(patch["scene"]); !resolved) return resolved;
    } else if (auto resolved = session.waitForScene(nullptr); !resolved) {
        return resolved;
    }

    // One patch for all settings, as some hold only together; the resolved state gives arrays their elements.
    Json patch = streamPatch(options);
    const auto settings = protocol::settingsPatch(session.state(), options.settings);
    if (!settings) return tl::make_unexpected("--set " + settings.error().field + ": " + settings.error().message);
    // The protocol lets a name pass that the scene does not have; here it can only be a slip.
    for (const char* kind : {"lights", "materials"}) {
        if (!settings->contains(kind) || !(*settings)[kind].is_object()) continue;
        const Json known = session.state().value(kind, Json::object());
        for (const auto& [name, value] : (*settings)[kind].items())
            if (!known.contains(name))
                return tl::make_unexpected("--set " + std::string(kind) + "." + name + ": the scene has no such name; its " +
                                           kind + " are " + namesOf(known));
    }
    protocol::extendPatch(patch, *settings);
    return session.update(patch);
}

}  // namespace caustream::shot
