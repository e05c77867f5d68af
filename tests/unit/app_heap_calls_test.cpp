#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "app/heap_calls.hpp"
#include "app/thread_schedule.hpp"
#include "tests/support/heap_calls.hpp"

// This executable has app/heap_interposer.cpp among its sources.
namespace hitchview::app {
namespace {

class HeapCallsTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    }
    void TearDown() override { StopCountingHeapCalls(); }

    /// Asks for memory so often.
    static void Allocate(int times) {
        for (int i = 0; i < times; ++i) {
            std::unique_ptr<char[]> memory(new char[100]);
            asm volatile("" ::"r"(memory.get()) : "memory");
        }
    }
    static void AllocateOnThread(const std::string& name, int times) {
        std::thread([=] {
            NameThisThread(name);
            Allocate(times);
        }).join();
    }
    static HeapCallCounts Counts() { return CountHeapCalls().value(); }
};

TEST_F(HeapCallsTest, NothingIsCountedBeforeTheStartAndAfterTheEnd) {
    Allocate(10);
    StartCountingHeapCalls(OnHeapCall::kCount);
    StopCountingHeapCalls();
    Allocate(10);
    EXPECT_EQ(Counts().frame_path, 0U);
}

TEST_F(HeapCallsTest, EveryKindOfCallIsCounted) {
    StartCountingHeapCalls(OnHeapCall::kCount);
    void* blocks[5] = {std::malloc(10), std::calloc(2, 10), std::aligned_alloc(64, 64),
                       ::operator new(10), ::operator new (64, std::align_val_t{64})};
    blocks[0] = std::realloc(blocks[0], 5000);
    void* aligned = nullptr;
    EXPECT_EQ(posix_memalign(&aligned, 64, 10), 0);
    StopCountingHeapCalls();
    asm volatile("" ::"r"(&blocks), "r"(&aligned) : "memory");  // the compiler may not spare a call
    EXPECT_EQ(Counts().frame_path, 7U);
    for (const int i : {0, 1, 2}) std::free(blocks[i]);
    ::operator delete(blocks[3]);
    ::operator delete (blocks[4], std::align_val_t{64});
    std::free(aligned);
}

TEST_F(HeapCallsTest, ThreadsOfFilesAreCountedApart) {
    StartCountingHeapCalls(OnHeapCall::kCount);
    AllocateOnThread("src-front", 20);
    AllocateOnThread("out-panorama", 30);
    AllocateOnThread("worker-1", 40);
    StopCountingHeapCalls();
    const HeapCallCounts counts = Counts();
    EXPECT_EQ(counts.files, 50U);
    const auto worker =
        std::ranges::find(counts.threads, std::string("worker-1"), &HeapCallCounts::Thread::name);
    ASSERT_NE(worker, counts.threads.end());
    EXPECT_EQ(worker->calls, 40U);
    EXPECT_GE(counts.frame_path, 40U);  // and what this thread took to start the others
}

TEST_F(HeapCallsTest, EachCountBeginsAtZero) {
    StartCountingHeapCalls(OnHeapCall::kCount);
    Allocate(10);
    StartCountingHeapCalls(OnHeapCall::kCount);
    Allocate(3);
    StopCountingHeapCalls();
    EXPECT_EQ(Counts().frame_path, 3U);
}

TEST_F(HeapCallsTest, ManyMoreThreadsThanARigHasAreStillCounted) {
    StartCountingHeapCalls(OnHeapCall::kCount);
    for (int i = 0; i < 100; ++i) AllocateOnThread("worker-" + std::to_string(i), 5);
    StopCountingHeapCalls();
    EXPECT_GE(Counts().frame_path, 500U);
}

using HeapCallsDeathTest = HeapCallsTest;

TEST_F(HeapCallsDeathTest, TheTrapNamesTheThreadAndLetsFilesPass) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto trap = [](const char* name) {
        std::thread thread([name] {
            NameThisThread(name);
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            Allocate(1);
        });
        StartCountingHeapCalls(OnHeapCall::kTrap);
        thread.join();
        StopCountingHeapCalls();
    };
    EXPECT_DEATH(trap("worker-7"), "heap call after READY on thread 'worker-7', called from:");
    trap("src-rear");
}

}  // namespace
}  // namespace hitchview::app
