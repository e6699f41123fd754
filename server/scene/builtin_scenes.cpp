#include "scene/builtin_scenes.h"

#include <vector>

#include "embedded/scenes.h"

namespace caustream::scene {

std::span<const BuiltinScene> builtinScenes() {
    static const std::vector<BuiltinScene> scenes = [] {
        std::vector<BuiltinScene> list;
        for (const embedded::File& file : embedded::scenes())
            list.push_back({file.name.substr(0, file.name.rfind(".glb")), file.bytes});
        return list;
    }();
    return scenes;
}

tl::expected<Scene, LoadError> loadBuiltin(std::string_view name, const LoadObserver& observer) {
    std::string known;
    for (const BuiltinScene& scene : builtinScenes()) {
        if (scene.name == name) return loadGlb(std::as_bytes(std::span(scene.glb)), std::string(name), {}, observer);
        known += (known.empty() ? "" : ", ") + std::string(scene.name);
    }
    return tl::unexpected(LoadError{"no built-in scene is called \"" + std::string(name) + "\"; there are " + known});
}

}  // namespace caustream::scene
