// The short form of `caustream-bench stability`: its named cases in refined mode, a group a test, and those about exact
// surfaces in traced mode.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "bench/stability/examine.h"

namespace caustream::stability {
namespace {

constexpr int kRoundTripFrames = 8;

std::vector<std::string> groups() {
    std::vector<std::string> groups;
    for (const Case& one : allCases(0)) {
        if (one.group != kLargeGroup && std::find(groups.begin(), groups.end(), one.group) == groups.end()) groups.push_back(one.group);
    }
    return groups;
}

class Stability : public testing::TestWithParam<std::string> {};

void expectStable(const std::string& group, const std::string& modeName) {
    Renderer renderer("software");
    const auto mode = std::find_if(modes().begin(), modes().end(), [&](const Mode& m) { return m.name == modeName; });
    ASSERT_NE(mode, modes().end());
    for (const Case& one : allCases(0)) {
        if (one.group != group) continue;
        for (const Failure& failure : examine(renderer, one, *mode, kRoundTripFrames).failures) {
            ADD_FAILURE() << "caustream-bench stability --case " << one.name << " --mode " << modeName << ": " << failure.check << ": " << failure.what;
        }
    }
}

TEST_P(Stability, EveryCaseIsFiniteClosedRepeatableAndSteady) { expectStable(GetParam(), "refined"); }

std::string nameOf(std::string group) {
    std::erase_if(group, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });   // what GoogleTest takes
    return group;
}

INSTANTIATE_TEST_SUITE_P(Groups, Stability, testing::ValuesIn(groups()), [](const auto& group) { return nameOf(group.param); });

class TracedStability : public testing::TestWithParam<std::string> {};

TEST_P(TracedStability, EveryCaseIsFiniteClosedRepeatableAndSteady) { expectStable(GetParam(), "traced"); }

INSTANTIATE_TEST_SUITE_P(Groups, TracedStability, testing::Values("nested", "aimed", "bounces", "mirror"), [](const auto& group) { return nameOf(group.param); });

TEST(StabilityCases, ThereAreTwoHundredCasesAndEachNameIsOnce) {
    std::vector<std::string> names;
    for (const Case& one : allCases(80)) names.push_back(one.name);
    EXPECT_GE(names.size(), 200u);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace caustream::stability
