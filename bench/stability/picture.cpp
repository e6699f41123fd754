#include "bench/stability/picture.h"

#include <fstream>

#include "error.h"
#include "render/pipeline.h"

namespace caustream::stability {

void writePicture(Renderer& renderer, const Case& which, const Mode& mode, const std::string& path) {
    const Setup setup = which.make();
    render::Request request;
    request.scene = std::make_shared<const scene::Scene>(setup.scene);
    request.camera = setup.scene.cameras.front();
    request.transport = setup.transport;
    request.transport.mode = mode.transport;
    if (!setup.ownWavelengths) request.transport.wavelengths = mode.wavelengths;
    request.width = request.height = 256;
    request.still = true;
    const render::Frame frame = render::Pipeline(*renderer.context, renderer.shaders).run(request);
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << frame.width << ' ' << frame.height << "\n255\n";
    file.write(reinterpret_cast<const char*>(frame.pixels.data()), static_cast<std::streamsize>(frame.pixels.size()));
    if (!file) throw Error("cannot write " + path + "; is its folder there?");
}

}  // namespace caustream::stability
