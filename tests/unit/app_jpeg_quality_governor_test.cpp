#include <gtest/gtest.h>

#include <cmath>

#include "app/jpeg_quality_governor.hpp"

namespace hitchview::app {
namespace {

constexpr JpegQualityGovernorOptions kOptions{.budget_bytes = 100'000, .highest_quality = 80};

void NoteMany(JpegQualityGovernor& governor, std::size_t bytes, int count) {
    for (int i = 0; i < count; ++i) governor.Note(bytes);
}

TEST(JpegQualityGovernorTest, WithinTheBudgetNothingChanges) {
    JpegQualityGovernor governor(kOptions);
    NoteMany(governor, 100'000, 100);
    EXPECT_EQ(governor.quality(), 80);
    EXPECT_TRUE(governor.IsWithinBudget(100'000));
    EXPECT_FALSE(governor.IsWithinBudget(100'001));
}

TEST(JpegQualityGovernorTest, ALargerExcessLowersTheQualityMore) {
    int lowest = 80;
    for (const std::size_t bytes : {100'001U, 120'000U, 150'000U, 180'000U}) {
        JpegQualityGovernor governor(kOptions);
        governor.Note(bytes);
        EXPECT_LT(governor.quality(), lowest) << bytes;
        lowest = governor.quality();
    }
}

TEST(JpegQualityGovernorTest, TheQualityStaysInItsRange) {
    JpegQualityGovernor governor(kOptions);
    governor.Note(100'000'000);
    EXPECT_EQ(governor.quality(), JpegQualityGovernor::kLowestQuality);
    NoteMany(governor, 1, 10'000);
    EXPECT_EQ(governor.quality(), 80);
}

TEST(JpegQualityGovernorTest, TheQualityRisesByOneAfterThirtyCalmPictures) {
    JpegQualityGovernor governor(kOptions);
    governor.Note(150'000);
    const int lowered = governor.quality();
    NoteMany(governor, 79'000, 29);
    EXPECT_EQ(governor.quality(), lowered);
    governor.Note(79'000);
    EXPECT_EQ(governor.quality(), lowered + 1);
}

TEST(JpegQualityGovernorTest, PicturesNearTheBudgetKeepTheQualityWhereItIs) {
    JpegQualityGovernor governor(kOptions);
    governor.Note(150'000);
    const int lowered = governor.quality();
    for (int i = 0; i < 100; ++i) {
        NoteMany(governor, 79'000, 29);
        governor.Note(81'000);
    }
    EXPECT_EQ(governor.quality(), lowered);
}

/// Pictures whose size follows the usual law: the loop must settle instead of swinging.
TEST(JpegQualityGovernorTest, OnASteadySceneTheQualitySettles) {
    const auto bytes_at = [](int quality) {
        const double scale = quality < 50 ? 50.0 / quality : 2 - quality / 50.0;
        return static_cast<std::size_t>(100'000 * std::pow(scale, -0.7));
    };
    JpegQualityGovernor governor(kOptions);
    for (int i = 0; i < 3000; ++i) governor.Note(bytes_at(governor.quality()));
    const int settled = governor.quality();
    EXPECT_LE(bytes_at(settled), 100'000U);
    for (int i = 0; i < 300; ++i) {
        governor.Note(bytes_at(governor.quality()));
        ASSERT_EQ(governor.quality(), settled);
    }
}

}  // namespace
}  // namespace hitchview::app
