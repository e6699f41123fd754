// Who waits for a file hears how far it has come, and can end it.
#include <gtest/gtest.h>

#include "glb_editor.h"
#include "scene/builtin_scenes.h"

namespace caustream::test {
namespace {

std::span<const std::byte> builtin(std::string_view name) {
    for (const scene::BuiltinScene& one : scene::builtinScenes())
        if (one.name == name) return std::as_bytes(std::span(one.glb));
    return {};
}

std::vector<double> shares(std::span<const std::byte> file) {
    std::vector<double> told;
    const auto observer = [&](double share) {
        told.push_back(share);
        return true;
    };
    EXPECT_TRUE(scene::loadGlb(file, "test", {}, observer));
    return told;
}

TEST(LoadObserver, TheShareGrowsToTheEnd) {
    for (const scene::BuiltinScene& one : scene::builtinScenes()) {
        const std::vector<double> told = shares(std::as_bytes(std::span(one.glb)));
        ASSERT_FALSE(told.empty()) << one.name;
        EXPECT_TRUE(std::ranges::is_sorted(told)) << one.name;
        EXPECT_GE(told.front(), 0.0);
        EXPECT_LE(told.back(), 1.0);
        EXPECT_GT(told.back(), 0.7) << one.name << ": the meshes are most of the work, and were announced";
    }
}

TEST(LoadObserver, EndsAtEveryCall) {
    const auto file = builtin("gem");
    const std::size_t calls = shares(file).size();
    ASSERT_GT(calls, 3u);
    for (std::size_t end = 0; end < calls; ++end) {
        std::size_t call = 0;
        const auto scene = scene::loadGlb(file, "test", {}, [&](double) { return call++ < end; });
        ASSERT_FALSE(scene) << end;
        EXPECT_TRUE(scene.error().cancelled);
        EXPECT_EQ(call, end + 1) << "no call after the end";
    }
}

TEST(LoadObserver, WhatIsWrongWithAFileIsNotCalledAnEnd) {
    const std::vector<std::uint8_t> nothing(100, 0);
    const auto scene = load(nothing);
    ASSERT_FALSE(scene);
    EXPECT_FALSE(scene.error().cancelled);
}

}  // namespace
}  // namespace caustream::test
