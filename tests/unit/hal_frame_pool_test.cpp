#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <thread>

#include "hal/frame_pool.hpp"
#include "hal/ring.hpp"

namespace hitchview::hal {
namespace {

constexpr FrameFormat kSmall{.width_px = 6, .height_px = 4};

FrameLease LeaseOne(FramePool& pool, std::uint8_t fill) {
    const std::optional<FramePool::Slot> maybe_slot = pool.Take();
    if (!maybe_slot) return {};
    std::ranges::fill(maybe_slot->bytes, fill);
    return pool.Lease(*maybe_slot, {.sequence = fill});
}

TEST(FrameFormatTest, PackedPlanesLieOneAfterAnother) {
    const std::uint8_t* const start = nullptr;
    const auto offset = [&](const Plane& plane) { return plane.data - start; };
    const FrameFormat i420{.width_px = 6, .height_px = 4, .pixel_format = PixelFormat::kI420};
    const auto planes = PackedPlanes(i420, start);
    EXPECT_EQ(offset(planes[1]), 24);
    EXPECT_EQ(offset(planes[2]), 30);
    EXPECT_EQ(planes[2].stride_bytes, 3);
    EXPECT_EQ(FrameBytes(i420), 36U);
    EXPECT_EQ(offset(PackedPlanes(kSmall, start)[1]), 24);
    EXPECT_EQ(PackedPlanes(kSmall, start)[1].stride_bytes, 6);
}

TEST(FramePoolTest, GivesEveryFrameOnceAndThenNone) {
    FramePool pool(kSmall, 3);
    std::set<const std::uint8_t*> addresses;
    for (int i = 0; i < 3; ++i) addresses.insert(pool.Take()->bytes.data());
    EXPECT_EQ(addresses.size(), 3U);
    for (const std::uint8_t* address : addresses) {
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(address) % 64, 0U);
    }
    EXPECT_FALSE(pool.Take());
    EXPECT_EQ(pool.free_count(), 0);
}

TEST(FramePoolTest, ALeaseShowsTheFrameAndGivesItBackWhenItDies) {
    FramePool pool(kSmall, 1);
    {
        const FrameLease lease = LeaseOne(pool, 77);
        EXPECT_EQ(lease.view().format, kSmall);
        EXPECT_EQ(lease.view().header.sequence, 77U);
        EXPECT_EQ(lease.view().planes[0].data[23], 77);
        EXPECT_EQ(lease.view().planes[1].data[11], 77);
        EXPECT_EQ(pool.free_count(), 0);
    }
    EXPECT_EQ(pool.free_count(), 1);
    EXPECT_EQ(pool.low_water(), 0);
}

TEST(FramePoolTest, AMovedLeaseGivesItsFrameBackOnce) {
    FramePool pool(kSmall, 2);
    FrameLease first = LeaseOne(pool, 1);
    FrameLease second = LeaseOne(pool, 2);
    first = std::move(second);
    EXPECT_EQ(pool.free_count(), 1);
    EXPECT_EQ(first.view().header.sequence, 2U);
    first.Release();
    first.Release();
    EXPECT_FALSE(first);
    EXPECT_EQ(pool.free_count(), 2);
}

TEST(FramePoolTest, AllSixtyFourSlotsCanBeUsed) {
    FramePool pool(kSmall, 64);
    for (int i = 0; i < 64; ++i) EXPECT_TRUE(pool.Take());
    EXPECT_FALSE(pool.Take());
}

TEST(FramePoolDeathTest, OurOwnMistakesStopTheProcess) {
    EXPECT_DEATH(FramePool(kSmall, 0), "expectation failed");
    EXPECT_DEATH(FramePool(kSmall, 65), "expectation failed");
    FramePool pool(kSmall, 2);
    const FramePool::Slot slot = *pool.Take();
    pool.Return(slot);
    EXPECT_DEATH(pool.Return(slot), "expectation failed");
    EXPECT_DEATH((void)FrameLease().view(), "expectation failed");
}

TEST(FramePoolTest, LeasesThatDieOnAnotherThreadGiveWholeFramesBack) {
    constexpr int kFrames = 20'000;
    FramePool pool(kSmall, 4);
    Ring<FrameLease, 4> ring;
    std::thread writer([&] {
        for (int i = 0; i < kFrames;) {
            FrameLease lease = LeaseOne(pool, static_cast<std::uint8_t>(i));
            if (!lease) continue;
            while (!ring.Append(std::move(lease))) std::this_thread::yield();
            ++i;
        }
    });
    int broken = 0;
    for (int i = 0; i < kFrames;) {
        const std::optional<FrameLease> maybe_lease = ring.Take();
        if (!maybe_lease) continue;
        const FrameView& view = maybe_lease->view();
        const auto whole = [&](std::uint8_t byte) { return byte == static_cast<std::uint8_t>(i); };
        broken += std::all_of(view.planes[0].data, view.planes[0].data + 36, whole) ? 0 : 1;
        ++i;
    }
    writer.join();
    EXPECT_EQ(broken, 0);
    EXPECT_EQ(pool.free_count(), 4);
}

}  // namespace
}  // namespace hitchview::hal
