#include "scenes/builtin.h"

#include <stdexcept>

#include "scenes/settings.h"

namespace caustream::scenes {

std::vector<std::uint8_t> makeBuiltin(const std::string& name) {
    if (name == "sphere") return makeSphere();
    if (name == "ring") return makeRing();
    if (name == "gem") return makeGem();
    if (name == "bunny") return makeBunny(CAUSTREAM_BUNNY_OBJ);
    if (name == "glass") return makeGlass();
    if (name == "prism") return makePrism();
    if (name == "brilliant") return makeBrilliant();
    if (name == "emerald") return makeEmerald();
    if (name == "water") return makeWater();
    if (name == "jewel") return makeJewel();
    if (name == "newton") return makeNewton();
    if (name == "ball") return makeBall();
    throw std::runtime_error("no scene is called \"" + name + "\"");
}

}  // namespace caustream::scenes
