// Whatever a frame leaves out, its picture is the one that it would have been.
#include "bench/omission_cases.h"
#include "tests/image/image_fixture.h"

namespace caustream::image {
namespace {

class Omissions : public ImageTest, public testing::WithParamInterface<int> {
   protected:
    static const bench::OmissionCase& one() {
        static const std::vector<bench::OmissionCase> cases = bench::omissionCases(128, 96);
        return cases.at(static_cast<std::size_t>(GetParam()));
    }
};

TEST_P(Omissions, ChangeNoPicture) {
    const bench::OmissionCase& tested = one();
    ASSERT_EQ(static_cast<int>(tested.omission), GetParam()) << "a case for each omission, in their order";
    // A first frame fills the caches; what is compared is the next, after the move that the case is about.
    pipeline().run(tested.moved(0));
    render::Request request = tested.moved(1);
    const render::Frame leftOut = pipeline().run(request);
    request.forced.add(tested.omission);
    const render::Frame done = pipeline().run(request);
    ASSERT_EQ(leftOut.pixels.size(), done.pixels.size());
    if (tested.request.sample != render::Sample::U8) {
        EXPECT_EQ(leftOut.pixels, done.pixels);
        return;
    }
    int most = 0;
    for (std::size_t i = 0; i < done.pixels.size(); ++i) most = std::max(most, std::abs(int(done.pixels[i]) - int(leftOut.pixels[i])));
    EXPECT_LE(most, tested.tolerance) << tested.why;
}

INSTANTIATE_TEST_SUITE_P(All, Omissions, testing::Range(0, static_cast<int>(render::Omission::Count)),
                         [](const auto& test) { return render::kOmissions[static_cast<std::size_t>(test.param)].name; });

}  // namespace
}  // namespace caustream::image
