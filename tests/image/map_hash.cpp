// Prints the hash of one scene's fixed-point map, for test_determinism to run under different environments.
#include <cstdio>

#include "gl/context.h"
#include "gl/shader_library.h"
#include "scene/builtin_scenes.h"
#include "tests/image/image_fixture.h"

int main() {
    using namespace caustream;
    const auto context = gl::Context::create({.gpu = "software"});
    gl::ShaderLibrary shaders;
    render::Pipeline pipeline(*context, shaders);
    const auto scene = scene::loadBuiltin("gem");
    if (!scene) return 1;
    render::Request request = image::mapRequest(*scene);
    request.still = true;
    std::printf("%016llx\n", static_cast<unsigned long long>(pipeline.run(request).mapHash));
}
