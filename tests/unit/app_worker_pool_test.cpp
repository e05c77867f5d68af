#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "app/worker_pool.hpp"

namespace hitchview::app {
namespace {

using testing::Each;
using testing::HasSubstr;

class WorkerPoolTest : public testing::TestWithParam<int> {};

TEST_P(WorkerPoolTest, EveryPieceIsDoneOnceHoweverManyThereAre) {
    WorkerPool pool(GetParam());
    for (const int count : {0, 1, 2, 3, 7, 64, 1000}) {
        std::vector<std::atomic<int>> done(static_cast<std::size_t>(count));
        pool.Run(count, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
        EXPECT_THAT(std::vector<int>(done.begin(), done.end()), Each(1)) << count;
    }
}

TEST_P(WorkerPoolTest, ManySmallJobsInARowDoNotMix) {
    WorkerPool pool(GetParam());
    constexpr int kJobs = 3000;
    constexpr int kPieces = 5;
    for (int job = 0; job < kJobs; ++job) {
        std::array<std::atomic<int>, kPieces> seen{};
        pool.Run(kPieces, [&, job](int i) { seen[static_cast<std::size_t>(i)] += job + 1; });
        ASSERT_THAT(std::vector<int>(seen.begin(), seen.end()), Each(job + 1));
    }
}

TEST_P(WorkerPoolTest, AThreadThatFellAsleepWakesUpAgain) {
    WorkerPool pool(GetParam());
    std::atomic<int> sum{0};
    for (int job = 0; job < 5; ++job) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        pool.Run(10, [&](int i) { sum += i; });
    }
    EXPECT_EQ(sum, 5 * 45);
}

TEST_P(WorkerPoolTest, NoMoreThreadsThanAskedForTakePart) {
    WorkerPool pool(GetParam());
    std::mutex mutex;
    std::set<std::thread::id> threads;
    for (int job = 0; job < 50; ++job) {
        pool.Run(8, [&](int) {
            const std::lock_guard lock(mutex);
            threads.insert(std::this_thread::get_id());
        });
    }
    EXPECT_LE(threads.size(), static_cast<std::size_t>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Workers, WorkerPoolTest, testing::Values(1, 2, 5, 16));

TEST(WorkerPoolScheduleTest, WhatTheKernelRefusesIsSaidAndTheWorkIsDone) {
    WorkerPool pool(2, {.affinity = {255}});
    EXPECT_THAT(pool.refusal(), HasSubstr("threads.affinity is refused"));
    EXPECT_THAT(pool.refusal(), HasSubstr("AllowedCPUs="));
    std::atomic<int> pieces{0};
    pool.Run(100, [&](int) { ++pieces; });
    EXPECT_EQ(pieces, 100);
}

TEST(WorkerPoolScheduleTest, AnAffinityThatTheMachineHasIsTaken) {
    const WorkerPool pool(2, {.affinity = {sched_getcpu()}});
    EXPECT_EQ(pool.refusal(), "");
}

}  // namespace
}  // namespace hitchview::app
