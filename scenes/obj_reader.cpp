#include "scenes/obj_reader.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace caustream::scenes {

Mesh readObj(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot open " + path);
    Mesh mesh;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        bool good = true;
        if (kind == "v") {
            glm::vec3 p(0.0f);
            good = static_cast<bool>(words >> p.x >> p.y >> p.z);
            mesh.positions.push_back(p);
        } else if (kind == "f") {
            for (int corner = 0; corner < 3; ++corner) {
                std::string word;
                words >> word;
                const long index = std::strtol(word.c_str(), nullptr, 10);  // up to a slash; counted from one
                good = good && index >= 1 && index <= static_cast<long>(mesh.positions.size());
                mesh.indices.push_back(static_cast<std::uint32_t>(index - 1));
            }
        }
        if (!good) throw std::runtime_error(path + ":" + std::to_string(number) + " cannot be read");
    }
    return mesh;
}

}  // namespace caustream::scenes
