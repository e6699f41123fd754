// Writes the seeds: make_corpus FOLDER. What fuzzing found lies beside them and is left alone.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "protocol/patch.h"
#include "small_scenes.h"
#include "tests/protocol/samples.h"

namespace {

using namespace caustream;

template <class Bytes>
void write(const std::filesystem::path& path, const Bytes& bytes) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

template <class Samples>
void writeTexts(const std::filesystem::path& folder, const Samples& samples) {
    std::map<std::string, int> used;
    for (const auto& sample : samples) {
        const std::string op = protocol::Json::parse(sample.text)["op"];
        std::string name = op;
        if (const int number = ++used[op]; number > 1) {
            name.append("-").append(std::to_string(number));
        }
        write(folder / name.append(".json"), sample.text);
    }
}

void writeHeaders(const std::filesystem::path& folder) {
    protocol::FrameHeader frame{.encoding = protocol::Encoding::Raw, .width = 4, .height = 4, .viewWidth = 4, .viewHeight = 4};
    frame.payloadLen = frame.rawLen = 48;
    const auto frameStart = protocol::encodeHeader(frame);
    const auto chunkStart = protocol::encodeHeader(protocol::ChunkHeader{.asset = 1, .payloadLen = 48});
    for (const auto& [name, start] : {std::pair{"frame", std::vector(frameStart.begin(), frameStart.end())},
                                      std::pair{"chunk", std::vector(chunkStart.begin(), chunkStart.end())}}) {
        std::vector<std::uint8_t> message = start;
        message.resize(message.size() + 48);
        write(folder / name, message);
    }
}

void writePatches(const std::filesystem::path& folder) {
    const protocol::Json full = protocol::toJson(protocol::fullState());
    const auto list = [](const protocol::Json& patches) { return patches.dump(); };
    write(folder / "full.json", list({full}));
    protocol::Json out = full;
    for (auto& [key, value] : out.items()) {
        value = nullptr;
    }
    write(folder / "in_and_out.json", list({full, out}));
    for (const auto& [key, value] : full.items()) {
        write(folder / (key + ".json"), list({{{key, value}}, {{key, nullptr}}}));
    }
    write(folder / "other_scene.json", list({full, protocol::sceneChange({protocol::SceneRef::Kind::Builtin, "prism"})}));
    write(folder / "exclusive.json", list({{{"transport", {{"mode", "refined"}, {"budget_ms", 8}}}}, {{"transport", {{"target_error", 0.1}}}}}));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("make_corpus: which folder; try: make_corpus tests/fuzz/corpus\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    writeTexts(folder / "client_text", protocol::clientSamples());
    writeTexts(folder / "server_text", protocol::serverSamples());
    writePatches(folder / "patches");
    writeHeaders(folder / "headers");
    for (const auto& [name, file] : fuzz::smallScenes()) {
        write(folder / "glb" / (name + ".glb"), file);
    }
}
