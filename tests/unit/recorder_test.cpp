// The log that a session may have: what its lines hold, whose it is, and that it ends.
#include "session/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

namespace caustream::session {
namespace {

using protocol::Json;
using testing::HasSubstr;

class RecorderTest : public testing::Test {
   protected:
    RecorderTest() {
        std::string name = std::filesystem::temp_directory_path() / "caustream-recorder-XXXXXX";
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
        folder_ = name;
    }
    ~RecorderTest() override { std::filesystem::remove_all(folder_); }

    std::vector<Json> lines(const std::string& name) const {
        std::ifstream in(folder_ / name);
        std::vector<Json> out;
        for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
        return out;
    }
    tl::expected<Recorder, std::string> start(const std::string& session, std::size_t most = Recorder::kLogBytes) const {
        return Recorder::start(folder_, session, {{"build", "7"}, {"state", {{"scene", {"builtin", "gem"}}}}}, most);
    }

    std::filesystem::path folder_;
};

TEST_F(RecorderTest, WritesALineAtATimeAndAnEnd) {
    {
        auto recorder = start("ab12");
        ASSERT_TRUE(recorder) << recorder.error();
        EXPECT_EQ(recorder->file(), "ab12-1.jsonl");
        EXPECT_EQ(lines("ab12-1.jsonl").size(), 1u) << "the header is in the file at once";
        EXPECT_FALSE(recorder->note({{"op", "input"}, {"seq", 1}}));
        const auto read = lines("ab12-1.jsonl");
        ASSERT_EQ(read.size(), 2u) << "and so is every line";
        EXPECT_EQ(read[0]["caustream_log"], 1);
        EXPECT_EQ(read[0]["session"], "ab12");
        EXPECT_EQ(read[0]["state"]["scene"][1], "gem");
        EXPECT_EQ(read[1]["seq"], 1);
        EXPECT_LT(read[1]["t_us"].get<std::uint64_t>(), 60'000'000u) << "counted from the start";
    }
    EXPECT_EQ(lines("ab12-1.jsonl").back()["op"], "end");
}

TEST_F(RecorderTest, IsItsOwnersAloneAndReplacesNothing) {
    const auto first = start("ab12");
    const auto second = start("ab12");
    ASSERT_TRUE(first && second);
    EXPECT_EQ(second->file(), "ab12-2.jsonl");
    struct stat about {};
    ASSERT_EQ(stat((folder_ / "ab12-1.jsonl").c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0600u);
}

TEST_F(RecorderTest, FollowsNoLinkAndNoPath) {
    std::filesystem::create_symlink(folder_ / "elsewhere", folder_ / "ab12-1.jsonl");
    const auto recorder = start("ab12");
    ASSERT_TRUE(recorder);
    EXPECT_EQ(recorder->file(), "ab12-2.jsonl");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "elsewhere"));
    for (const char* session : {"", "../up", "a/b", ".", "a.b", "a\nb"}) EXPECT_FALSE(start(session)) << session;
    EXPECT_FALSE(start(std::string(65, 'a')));
}

TEST_F(RecorderTest, EndsWhereItsBytesEndAndSaysSo) {
    constexpr std::size_t kMost = 4096;
    auto recorder = start("ab12", kMost);
    ASSERT_TRUE(recorder);
    std::optional<std::string> ended;
    int noted = 0;
    for (; !ended && noted < 1000; ++noted) ended = recorder->note({{"op", "input"}, {"pad", std::string(100, 'x')}});
    ASSERT_TRUE(ended);
    EXPECT_THAT(*ended, HasSubstr("4096 bytes"));
    EXPECT_FALSE(recorder->note({{"op", "input"}})) << "said once";
    const auto read = lines("ab12-1.jsonl");
    EXPECT_EQ(read.size(), static_cast<std::size_t>(noted) + 1) << "header, all but the last, the end";
    EXPECT_EQ(read.back()["op"], "end");
    EXPECT_THAT(read.back()["reason"].get<std::string>(), HasSubstr("4096 bytes"));
    EXPECT_LE(std::filesystem::file_size(folder_ / "ab12-1.jsonl"), kMost + 256);
}

TEST_F(RecorderTest, AFolderThatIsNoneIsAnError) {
    const auto recorder = Recorder::start(folder_ / "no such folder", "ab12", Json::object());
    ASSERT_FALSE(recorder);
    EXPECT_THAT(recorder.error(), HasSubstr("cannot write its logs"));
}

}  // namespace
}  // namespace caustream::session
