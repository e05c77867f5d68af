#include <gtest/gtest.h>

#include "algo/corner_samples.hpp"

namespace hitchview::algo {
namespace {

CornerSamples::Sample Named(float name) {
    return {{name, 2 * name}, {3 * name, 4 * name}, 5 * name};
}

std::vector<float> NamesOf(const CornerSamples& samples, int row, int first, int last) {
    std::vector<float> names;
    const auto [begin, end] = samples.Of(row, first, last);
    for (int place = begin; place < end; ++place) names.push_back(samples.At(place).at_px.x());
    return names;
}

TEST(CornerSamplesTest, GivesTheSamplesOfARowOfCornersInTheOrderOfCornersThenOfComing) {
    CornerSamples samples(3, 4, 10);
    samples.Add(1, 2, Named(1));
    samples.Add(1, 1, Named(2));
    samples.Add(2, 0, Named(3));
    samples.Add(1, 2, Named(4));
    samples.Sort();
    EXPECT_EQ(NamesOf(samples, 1, 0, 3), (std::vector<float>{2, 1, 4}));
    EXPECT_EQ(NamesOf(samples, 1, 2, 2), (std::vector<float>{1, 4}));
    EXPECT_EQ(NamesOf(samples, 2, 0, 3), (std::vector<float>{3}));
    EXPECT_TRUE(NamesOf(samples, 0, 0, 3).empty());
}

TEST(CornerSamplesTest, KeepsAllThatASampleSays) {
    CornerSamples samples(1, 1, 2);
    samples.Add(0, 0, Named(7));
    samples.Sort();
    const CornerSamples::Sample sample = samples.At(0);
    EXPECT_EQ(sample.at_px, Named(7).at_px);
    EXPECT_EQ(sample.e_px, Named(7).e_px);
    EXPECT_EQ(sample.weight, Named(7).weight);
}

TEST(CornerSamplesTest, LeavesOutWhatIsTooMuchAndForgetsWhatIsCleared) {
    CornerSamples samples(1, 1, 2);
    for (const float name : {1.0F, 2.0F, 3.0F}) samples.Add(0, 0, Named(name));
    samples.Sort();
    EXPECT_EQ(NamesOf(samples, 0, 0, 0), (std::vector<float>{1, 2}));
    samples.Clear();
    samples.Sort();
    EXPECT_TRUE(NamesOf(samples, 0, 0, 0).empty());
}

}  // namespace
}  // namespace hitchview::algo
