#include <gtest/gtest.h>

#include "drivers/lcm_publisher.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/heap_calls.hpp"

// Runs in a network namespace of its own (tests/support/lcm_namespace.sh).
namespace hitchview {
namespace {

using tests::HeapCallsOfThisThread;

TEST(LcmHeapTest, PublishingTakesNoMemory) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    drivers::SteadyClock clock;
    auto publisher = drivers::LcmPublisher::Create({}, clock);
    ASSERT_TRUE(publisher) << publisher.error();
    const std::vector<std::uint8_t> jpeg(150'000, 1);
    const hal::PanoramaImage image{.calibration_id = "0123456789abcdef", .jpeg = jpeg};

    bool all_sent = true;
    const std::uint64_t before = HeapCallsOfThisThread();
    for (int i = 0; i < 50; ++i) {
        all_sent = publisher.value()->Publish(image).ok() &&
                   publisher.value()->Publish(hal::PanoramaStatus{}).ok() &&
                   publisher.value()->Publish(hal::HitchAngle{}).ok() &&
                   publisher.value()->Publish(hal::Event{}).ok() &&
                   publisher.value()->Publish(hal::Health{}).ok() &&
                   publisher.value()->Publish(hal::Overlay{}).ok() &&
                   publisher.value()->Publish(hal::PreviewImage{"PREVIEW_A"}).ok() && all_sent;
    }
    EXPECT_EQ(HeapCallsOfThisThread(), before);
    EXPECT_TRUE(all_sent);
}

TEST(LcmHeapTest, TheCounterSeesAnAllocation) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    const std::uint64_t before = HeapCallsOfThisThread();
    const std::vector<int> memory(100);
    EXPECT_GT(HeapCallsOfThisThread(), before);
}

}  // namespace
}  // namespace hitchview
