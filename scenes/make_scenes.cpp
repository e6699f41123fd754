// make_scenes DIR NAME...: writes DIR/NAME.glb for each of the embedded scenes. Run by the build.
#include <exception>
#include <fstream>
#include <iostream>

#include "scenes/builtin.h"

int main(int argc, char** argv) try {
    for (int i = 2; i < argc; ++i) {
        const std::string path = std::string(argv[1]) + "/" + argv[i] + ".glb";
        const std::vector<std::uint8_t> glb = caustream::scenes::makeBuiltin(argv[i]);
        std::ofstream file(path, std::ios::binary);
        file.write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
        if (!file.flush()) throw std::runtime_error("cannot write " + path);
    }
    return 0;
} catch (const std::exception& error) {
    std::cerr << "make_scenes: " << error.what() << '\n';
    return 1;
}
