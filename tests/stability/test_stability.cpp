// The short form of `caustream-bench stability`: its named cases in refined mode, a group a test.
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

TEST_P(Stability, EveryCaseIsFiniteClosedRepeatableAndSteady) {
    Renderer renderer("software");
    const Mode& refined = modes().front();
    for (const Case& one : allCases(0)) {
        if (one.group != GetParam()) continue;
        for (const Failure& failure : examine(renderer, one, refined, kRoundTripFrames).failures) {
            ADD_FAILURE() << "caustream-bench stability --case " << one.name << " --mode " << refined.name << ": " << failure.check << ": " << failure.what;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Groups, Stability, testing::ValuesIn(groups()), [](const auto& group) {
    std::string name = group.param;   // GoogleTest takes letters and digits only
    std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
    return name;
});

TEST(StabilityCases, ThereAreTwoHundredCasesAndEachNameIsOnce) {
    std::vector<std::string> names;
    for (const Case& one : allCases(80)) names.push_back(one.name);
    EXPECT_GE(names.size(), 200u);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace caustream::stability
