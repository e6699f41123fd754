// What the server keeps of scenes and files, and who reads them when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <functional>

#include "error.h"
#include "session/asset_directory.h"
#include "session/load_pool.h"
#include "session/load_progress.h"
#include "session/random_id.h"
#include "session/scene_store.h"

namespace caustream::session {
namespace {

namespace fs = std::filesystem;
using protocol::SceneRef;
using testing::ElementsAre;

SceneRef asset(const std::string& name) { return {SceneRef::Kind::Asset, name}; }

// Takes about `kilobytes` of memory.
scene::Scene sceneOf(std::size_t kilobytes) {
    auto geometry = std::make_shared<scene::Geometry>();
    geometry->textures.push_back({1, 1, std::vector<std::uint8_t>(kilobytes << 10)});
    scene::Scene scene;
    scene.geometry = geometry;
    return scene;
}

TEST(SceneStore, OneGeometryForAllWhoShowIt) {
    SceneStore store(1u << 20);
    const auto first = store.put(asset("a"), sceneOf(1));
    EXPECT_EQ(store.find(asset("a")), first);
    const scene::Geometry* geometry = first->geometry.get();
    const std::shared_ptr<const scene::Geometry> drawn = first->geometry;  // as the renderer holds it
    EXPECT_EQ(store.find(asset("a"))->geometry.get(), geometry);
    EXPECT_FALSE(store.find({SceneRef::Kind::Builtin, "a"}));
}

TEST(SceneStore, WhoHoldsTheGeometryAloneShowsIt) {
    SceneStore store(0);
    auto shown = store.put(asset("a"), sceneOf(1));
    std::shared_ptr<const scene::Geometry> drawn = shown->geometry;  // with a viewer's overrides, or by the renderer
    shown.reset();
    EXPECT_EQ(store.idleBytes(), 0u);
    drawn.reset();
    EXPECT_EQ(store.idleBytes() >> 10, 1u);
}

TEST(SceneStore, WhatNoOneShowsKeepsToTheBudget) {
    SceneStore store(100u << 10);
    store.put(asset("a"), sceneOf(40));
    store.put(asset("b"), sceneOf(40));
    EXPECT_EQ(store.idleBytes() >> 10, 80u);
    store.find(asset("a"));  // newest again
    store.put(asset("c"), sceneOf(40));
    store.trim();
    EXPECT_TRUE(store.find(asset("a")));
    EXPECT_FALSE(store.find(asset("b"))) << "the one not asked for longest";
    EXPECT_TRUE(store.find(asset("c")));
}

TEST(SceneStore, WhatIsShownIsBeyondTheBudget) {
    SceneStore store(100u << 10);
    auto shown = store.put(asset("shown"), sceneOf(500));
    for (const char* name : {"a", "b", "c", "d"}) {
        store.put(asset(name), sceneOf(40));
    }
    store.trim();
    EXPECT_EQ(store.find(asset("shown")), shown);
    shown.reset();
    store.put(asset("e"), sceneOf(40));
    store.trim();
    EXPECT_FALSE(store.find(asset("shown"))) << "too large to be kept";
    EXPECT_LE(store.idleBytes(), 100u << 10);
}

TEST(SceneStore, TheNewestStaysUntilItIsShown) {
    SceneStore store(0);
    store.put(asset("a"), sceneOf(500));
    store.trim();
    const auto shown = store.find(asset("a"));
    EXPECT_TRUE(shown) << "else a file larger than the budget could never be shown";
    store.put(asset("b"), sceneOf(1));
    store.trim();
    EXPECT_EQ(store.find(asset("a")), shown);
}

class AssetDirectoryTest : public testing::Test {
   protected:
    ~AssetDirectoryTest() override { fs::remove_all(folder_); }

    static std::vector<std::byte> file(char fill, std::size_t size = 1000) {
        return std::vector<std::byte>(size, static_cast<std::byte>(fill));
    }
    static std::string hashOf(const std::vector<std::byte>& bytes) {
        unsigned char digest[EVP_MAX_MD_SIZE];
        unsigned length = 0;
        EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr);
        return hex({digest, length});
    }
    fs::path pathOf(const std::string& hash) const { return folder_ / (hash + ".glb"); }
    std::size_t filesThere() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    void age(const std::string& hash, int hours) const {
        fs::last_write_time(pathOf(hash), fs::file_time_type::clock::now() - std::chrono::hours(hours));
    }

    fs::path folder_ = fs::temp_directory_path() / ("caustream-assets-" + randomId());
    AssetDirectory directory_{folder_, 10'000, 5'000};
};

TEST_F(AssetDirectoryTest, GivesBackWhatItWasGiven) {
    const auto bytes = file('x');
    const std::string hash = hashOf(bytes);
    EXPECT_FALSE(directory_.contains(hash));
    EXPECT_FALSE(directory_.read(hash));
    ASSERT_TRUE(directory_.write(hash, bytes));
    EXPECT_TRUE(directory_.contains(hash));
    EXPECT_EQ(directory_.read(hash), bytes);
    EXPECT_EQ(filesThere(), 1u) << "no file of another name is left";
    const AssetDirectory other(folder_, 10'000, 5'000);
    EXPECT_EQ(other.read(hash), bytes);
}

TEST_F(AssetDirectoryTest, AFileThatLiesAboutItsHashIsRemoved) {
    const std::string hash = hashOf(file('x'));
    std::ofstream(pathOf(hash)) << "something else";
    EXPECT_TRUE(directory_.contains(hash));
    EXPECT_FALSE(directory_.read(hash));
    EXPECT_FALSE(directory_.contains(hash));
    ASSERT_TRUE(directory_.write(hash, file('x')));
    EXPECT_TRUE(directory_.read(hash));
}

TEST_F(AssetDirectoryTest, OnlyRegularFilesOfAnAllowedSizeAreThere) {
    const auto large = file('x', 6'000);
    const std::string hash = hashOf(large);
    std::ofstream(pathOf(hash)).write(reinterpret_cast<const char*>(large.data()), 6'000);
    EXPECT_FALSE(directory_.contains(hash));
    EXPECT_FALSE(directory_.read(hash));
    const auto elsewhere = file('y');
    const std::string linked = hashOf(elsewhere);
    std::ofstream(folder_ / "elsewhere").write(reinterpret_cast<const char*>(elsewhere.data()), 1000);
    fs::create_symlink(folder_ / "elsewhere", pathOf(linked));
    EXPECT_FALSE(directory_.read(linked)) << "a link may lead anywhere";
    std::ofstream(pathOf(std::string(64, 'a')));
    EXPECT_FALSE(directory_.contains(std::string(64, 'a'))) << "empty";
}

TEST_F(AssetDirectoryTest, ANameIsAHashOrNothing) {
    std::ofstream(folder_ / "name.glb") << "x";
    for (const std::string& name : {std::string("name"), std::string("../name"), std::string(64, '.'), std::string(64, 'A'), std::string()}) {
        EXPECT_FALSE(directory_.contains(name));
        EXPECT_FALSE(directory_.read(name));
        EXPECT_TRUE(directory_.write(name, file('x')));
    }
    EXPECT_EQ(filesThere(), 1u);
}

TEST_F(AssetDirectoryTest, TheOldestGo) {
    std::vector<std::string> hashes;
    for (const char fill : {'a', 'b', 'c'}) {
        const auto bytes = file(fill, 3'000);
        hashes.push_back(hashOf(bytes));
        ASSERT_TRUE(directory_.write(hashes.back(), bytes));
    }
    age(hashes[0], 30);
    age(hashes[1], 20);
    age(hashes[2], 10);
    EXPECT_TRUE(directory_.read(hashes[0])) << "and is among the newest now";
    const auto bytes = file('d', 3'000);
    ASSERT_TRUE(directory_.write(hashOf(bytes), bytes));
    EXPECT_TRUE(directory_.contains(hashes[0]));
    EXPECT_FALSE(directory_.contains(hashes[1]));
    EXPECT_TRUE(directory_.contains(hashes[2]));
    EXPECT_TRUE(directory_.contains(hashOf(bytes)));
}

TEST_F(AssetDirectoryTest, WhatAnotherServerLeftHalfWrittenGoesInTime) {
    const fs::path fresh = folder_ / "fresh.part", old = folder_ / "old.part";
    std::ofstream(fresh) << "x";
    std::ofstream(old) << "x";
    fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
    const auto bytes = file('x');
    ASSERT_TRUE(directory_.write(hashOf(bytes), bytes));
    EXPECT_TRUE(fs::exists(fresh));
    EXPECT_FALSE(fs::exists(old));
}

TEST_F(AssetDirectoryTest, AFolderThatCannotBeWrittenToIsAnError) {
    std::ofstream(folder_ / "file") << "x";
    EXPECT_THROW(AssetDirectory(folder_ / "file" / "below", 1, 1), Error);
    fs::remove_all(folder_);
    EXPECT_FALSE(directory_.write(hashOf(file('x')), file('x'))) << "the folder has gone";
}

// A task that waits until it is let go, or ended.
class Gate {
   public:
    void open() {
        const std::lock_guard lock(mutex_);
        open_ = true;
        changed_.notify_all();
    }
    void waitUntilOpen() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return open_; });
    }

   private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool open_ = false;
};

TEST(LoadPool, OneOwnersFilesDoNotHoldUpAnothers) {
    Gate hold, otherDone;
    LoadPool pool;
    for (int i = 0; i < 5; ++i) {
        pool.submit(1, [&](const std::atomic<bool>&) { hold.waitUntilOpen(); });
    }
    pool.submit(2, [&](const std::atomic<bool>&) { otherDone.open(); });
    otherDone.waitUntilOpen();  // hangs if the first owner has both threads
    hold.open();
}

TEST(LoadPool, OneOwnersFilesAreReadInTheirOrder) {
    std::vector<int> order;
    Gate done;
    LoadPool pool;
    for (int i = 0; i < 20; ++i) {
        pool.submit(7, [&, i](const std::atomic<bool>&) {
            order.push_back(i);  // no lock: one at a time, and the pool's own orders them
            if (i == 19) done.open();
        });
    }
    done.waitUntilOpen();
    EXPECT_TRUE(std::ranges::is_sorted(order));
    EXPECT_EQ(order.size(), 20u);
}

// Two tasks of one owner: whether each was told to end, where `end` says so while the first runs.
std::vector<bool> toldOfTwo(LoadPool& pool, const std::function<void(const std::shared_ptr<std::atomic<bool>>& first)>& end) {
    Gate started, done;
    std::vector<bool> told;
    const auto ticket = pool.submit(1, [&](const std::atomic<bool>& ended) {
        started.open();
        while (!ended) std::this_thread::yield();
        told.push_back(true);
    });
    pool.submit(1, [&](const std::atomic<bool>& ended) {
        told.push_back(ended);
        done.open();
    });
    started.waitUntilOpen();
    end(ticket);
    done.waitUntilOpen();
    return told;
}

TEST(LoadPool, EndsWhatRunsAndTellsWhatWaits) {
    LoadPool pool;
    EXPECT_THAT(toldOfTwo(pool, [&](const auto&) { pool.end(1); }), ElementsAre(true, true));
    pool.end(2);  // nobody
}

TEST(LoadPool, OneTicketEndsOneTask) {
    LoadPool pool;
    EXPECT_THAT(toldOfTwo(pool, [](const auto& ticket) { *ticket = true; }), ElementsAre(true, false));
}

TEST(LoadPool, GoingAwayEndsWhatRuns) {
    Gate started;
    LoadPool pool;
    pool.submit(1, [&](const std::atomic<bool>& ended) {
        started.open();
        while (!ended) std::this_thread::yield();
    });
    started.waitUntilOpen();
}  // hangs if it does not

TEST(LoadProgress, FourTimesASecondAfterTheFirstQuarter) {
    LoadProgress progress(1'000'000);
    int said = 0;
    for (std::uint64_t us = 1'000'000; us <= 2'000'000; us += 10'000) {
        said += progress.due(us);
        if (us < 1'250'000) {
            EXPECT_EQ(said, 0);
        }
    }
    EXPECT_EQ(said, 4);
}

}  // namespace
}  // namespace caustream::session
