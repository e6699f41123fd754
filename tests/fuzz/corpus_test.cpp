// Every file of the corpus, seeds and what fuzzing found, through its target in the ordinary build.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "targets.h"

namespace caustream::fuzz {
namespace {

using Path = std::filesystem::path;

const Path kCorpus = Path(CAUSTREAM_TEST_DATA) / "corpus";

std::vector<std::uint8_t> read(const Path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A broken promise ends the process: the last line names the file.
void replay(const Target& target) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kCorpus / target.name)) {
        std::fprintf(stderr, "%s\n", entry.path().c_str());
        target.run(read(entry.path()));
        ++files;
    }
    EXPECT_GT(files, 0u);
}

TEST(Corpus, Texts) {
    for (const Target& target : kTextTargets) {
        replay(target);
    }
}

TEST(Corpus, Headers) { replay(kBinaryTargets[0]); }

TEST(Corpus, Scenes) { replay(kBinaryTargets[1]); }

// A texts' decoder meets the files of every other: none is so strange that it may fall over it.
TEST(Corpus, EveryTargetTakesEveryFile) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kCorpus)) {
        if (entry.is_regular_file()) {
            const std::vector<std::uint8_t> bytes = read(entry.path());
            for (const Target& target : kTextTargets) target.run(bytes);
            for (const Target& target : kBinaryTargets) target.run(bytes);
        }
    }
}

}  // namespace
}  // namespace caustream::fuzz
