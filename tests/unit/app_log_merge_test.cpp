#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/log_merge.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using Files = std::vector<std::filesystem::path>;
using testing::ElementsAre;

const std::atomic<bool> kGoOn{false};

/// Logs whose events are CLOCK messages at these seconds.
class LogMergeTest : public testing::Test {
 protected:
    std::filesystem::path Log(const std::string& name, const std::vector<int>& seconds) {
        const std::string file = folder_ / name;
        tests::MessageLog log(file);
        for (const int second : seconds) log.Clock(second * 1'000'000'000LL);
        return file;
    }

    static constexpr std::int64_t kEpoch_us = tests::MessageLog::kEpoch_ns / 1000;

    struct Place {
        std::int64_t second;
        std::size_t recording;
        std::size_t file;

        bool operator==(const Place&) const = default;
    };
    static std::vector<Place> Rest(LogMerge& merge) {
        std::vector<Place> places;
        while (const auto event = merge.Next())
            places.push_back({(event.value().event.utime_us - kEpoch_us) / 1'000'000,
                              event.value().recording, event.value().file});
        return places;
    }

    tests::TemporaryFolder folder_;
};

TEST_F(LogMergeTest, RecordingsGoOnTogether) {
    const Files a{Log("a0", {1, 4}), Log("a1", {6})};
    const Files b{Log("b", {2, 3, 5, 7})};
    LogMerge merge({a, b}, kGoOn);
    EXPECT_THAT(Rest(merge),
                ElementsAre(Place{1, 0, 0}, Place{2, 1, 0}, Place{3, 1, 0}, Place{4, 0, 0},
                            Place{5, 1, 0}, Place{6, 0, 1}, Place{7, 1, 0}));
}

TEST_F(LogMergeTest, ASeekFindsTheSegment) {
    const Files a{Log("a0", {1, 4}), Log("a1", {6, 8}), Log("a2", {9})};
    LogMerge merge({a}, kGoOn);
    merge.SeekToTime(kEpoch_us + 7'000'000);
    EXPECT_THAT(Rest(merge), ElementsAre(Place{8, 0, 1}, Place{9, 0, 2}));
    merge.SeekToTime(kEpoch_us + 2'000'000);
    EXPECT_THAT(Rest(merge),
                ElementsAre(Place{4, 0, 0}, Place{6, 0, 1}, Place{8, 0, 1}, Place{9, 0, 2}));
    merge.SeekToTime(kEpoch_us + 10'000'000);
    EXPECT_THAT(Rest(merge), ElementsAre());
}

TEST_F(LogMergeTest, AFileThatIsGoneIsNamed) {
    LogMerge merge({{folder_ / "gone.lcm"}}, kGoOn);
    const auto event = merge.Next();
    ASSERT_FALSE(event.ok());
    EXPECT_EQ(event.error(), hal::Error::kFailed);
    EXPECT_THAT(merge.failure(), testing::HasSubstr("gone.lcm"));
}

}  // namespace
}  // namespace hitchview::app
