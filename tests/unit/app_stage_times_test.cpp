#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "app/stage_times.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;

TEST(StageTimesTest, BeforeTheFirstTimeThereIsNothing) {
    const StageTimes times;
    EXPECT_TRUE(times.empty());
    EXPECT_EQ(times.Summarise().max_ms, 0);
}

TEST(StageTimesTest, OneTimeIsEveryFigure) {
    StageTimes times;
    times.Add(milliseconds(7));
    const auto s = times.Summarise();
    EXPECT_FALSE(times.empty());
    for (const double ms : {s.last_ms, s.p50_ms, s.p99_ms, s.max_ms}) EXPECT_EQ(ms, 7);
}

TEST(StageTimesTest, FiguresAreThoseOfTheSortedWindow) {
    std::mt19937 random(1);
    for (const std::size_t n : {2U, 3U, 100U, 1024U, 3000U}) {
        StageTimes times;
        std::vector<int> all(n);
        for (int& ms : all) {
            ms = static_cast<int>(random() % 100'000);
            times.Add(milliseconds(ms));
        }
        const int longest = *std::max_element(all.begin(), all.end());
        const auto window = all.end() - static_cast<int>(std::min(n, StageTimes::kWindow));
        std::sort(window, all.end());
        const auto s = times.Summarise();
        EXPECT_EQ(s.p50_ms, window[(all.end() - window) / 2]) << n;
        EXPECT_EQ(s.p99_ms, window[(all.end() - window) * 99 / 100]) << n;
        EXPECT_EQ(s.max_ms, longest) << n;
    }
}

}  // namespace
}  // namespace hitchview::app
