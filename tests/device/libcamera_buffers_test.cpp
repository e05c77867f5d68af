#include "drivers/libcamera_buffers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <set>
#include <vector>

#include "drivers/libcamera_configuration.hpp"
#include "drivers/libcamera_session.hpp"
#include "tests/device/vimc.hpp"
#include "tests/support/heap_calls.hpp"

// Lending itself, which does not ask what the pixels mean: vimc has no format that is lent.
namespace hitchview::drivers {
namespace {

class LibcameraBuffersTest : public tests::VimcTest {
 protected:
    void SetUp() override {
        VimcTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        auto session = LibcameraSession::Join();
        ASSERT_TRUE(session.ok()) << session.error();
        session_ = session.value();
        camera_ = session_->Find(tests::kVimcCamera);
        ASSERT_NE(camera_, nullptr);
        ASSERT_EQ(camera_->acquire(), 0);
        LibcameraOptions options;
        options.accept_granted_size = true;
        auto granted = AgreeWithLibcamera(*camera_, options);
        ASSERT_TRUE(granted.ok()) << granted.error();
        ASSERT_EQ(camera_->configure(granted.value().configuration.get()), 0);
        const auto taken = buffers_.Take(camera_, granted.value().stream().stream());
        ASSERT_TRUE(taken.ok()) << taken.error();
        camera_->requestCompleted.connect(this, &LibcameraBuffersTest::NoteCompleted);
        ASSERT_EQ(camera_->start(), 0);
        ASSERT_EQ(buffers_.Queue(*camera_), 0);
    }
    void TearDown() override {
        if (camera_ != nullptr) EndStream();
        session_.reset();
        VimcTest::TearDown();
    }

    void NoteCompleted(libcamera::Request* request) {
        const std::uint64_t before = tests::HeapCallsOfThisThread();
        if (request->status() == libcamera::Request::RequestComplete)
            mailbox_.NoteFilled(static_cast<int>(request->cookie()));
        heap_calls_ = tests::HeapCallsOfThisThread();
        heap_calls_of_hand_over_ += heap_calls_ - before;
    }
    int AwaitFilled() {
        for (int i = 0; i < 100; ++i) {
            const auto news = mailbox_.Take(std::chrono::seconds(1));
            buffers_.Collect(news.returned);
            if (!news.filled) continue;
            buffers_.NoteFilled(*news.filled);
            return *news.filled;
        }
        return -1;
    }
    hal::FrameLease Lend(int slot) {
        hal::FrameView view;
        view.planes[0].data = buffers_.memory(slot)[0].data();
        return buffers_.Lend(slot, view);
    }
    void EndStream() {
        camera_->stop();
        camera_->requestCompleted.disconnect(this);
        buffers_.Drop();
        mailbox_.ForgetStream();
        camera_->release();
        camera_.reset();
    }

    std::shared_ptr<LibcameraSession> session_;
    std::shared_ptr<libcamera::Camera> camera_;
    LibcameraMailbox mailbox_;
    LibcameraBuffers buffers_{mailbox_};
    std::atomic<std::uint64_t> heap_calls_ = 0;  ///< of libcamera's thread
    std::atomic<std::uint64_t> heap_calls_of_hand_over_ = 0;
};

TEST_F(LibcameraBuffersTest, ALentBufferIsLeftAloneUntilItComesBack) {
    const int slot = AwaitFilled();
    ASSERT_GE(slot, 0);
    const auto memory = buffers_.memory(slot)[0];
    hal::FrameLease lease = Lend(slot);
    const std::vector<std::uint8_t> before(memory.begin(), memory.end());
    for (int i = 0; i < 8; ++i) {
        ASSERT_EQ(buffers_.Queue(*camera_), 0);
        ASSERT_NE(AwaitFilled(), slot);
    }
    EXPECT_TRUE(std::equal(memory.begin(), memory.end(), before.begin()));
    lease.Release();
    std::set<int> seen;
    for (int i = 0; i < 8; ++i) {
        seen.insert(AwaitFilled());
        ASSERT_EQ(buffers_.Queue(*camera_), 0);
    }
    EXPECT_EQ(seen.count(slot), 1U);
}

TEST_F(LibcameraBuffersTest, ALentBufferCanBeReadAfterItsStreamHasEnded) {
    const int slot = AwaitFilled();
    ASSERT_GE(slot, 0);
    const auto memory = buffers_.memory(slot)[0];
    hal::FrameLease lease = Lend(slot);
    const std::vector<std::uint8_t> before(memory.begin(), memory.end());
    EndStream();
    EXPECT_TRUE(std::equal(memory.begin(), memory.end(), before.begin()));
}

TEST_F(LibcameraBuffersTest, OnlyLibcameraItselfTakesFromTheHeap) {
    constexpr int kFrames = 40;
    for (int i = 0; i < 10; ++i) {  // until the pipeline has settled
        ASSERT_EQ(buffers_.Queue(*camera_), 0);
        ASSERT_GE(AwaitFilled(), 0);
    }
    const std::uint64_t before = heap_calls_;
    std::uint64_t giving_back = 0;
    std::uint64_t ours = 0;
    for (int i = 0; i < kFrames; ++i) {
        const std::uint64_t start = tests::HeapCallsOfThisThread();
        ASSERT_EQ(buffers_.Queue(*camera_), 0);
        const std::uint64_t queued = tests::HeapCallsOfThisThread();
        const int slot = AwaitFilled();
        ASSERT_GE(slot, 0);
        Lend(slot).Release();
        giving_back += queued - start;
        ours += tests::HeapCallsOfThisThread() - queued;
    }
    std::printf("heap calls per frame: %.1f on libcamera's thread, %.1f in queueRequest\n",
                static_cast<double>(heap_calls_ - before) / kFrames,
                static_cast<double>(giving_back) / kFrames);
    EXPECT_EQ(ours, 0U);
    EXPECT_EQ(heap_calls_of_hand_over_, 0U);
}

}  // namespace
}  // namespace hitchview::drivers
