#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "hal/camera.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::tests {

/// Takes a camera's frames on a thread of its own, as the program does: reopens it with back-off,
/// 100 ms doubling to at most 500 ms.
class CameraFollower {
 public:
    using Clock = std::chrono::steady_clock;
    using Milliseconds = std::chrono::milliseconds;

    explicit CameraFollower(hal::Camera& camera) : camera_(camera), heard_at_(Clock::now()) {
        thread_ = std::thread([this] { Work(); });
    }
    ~CameraFollower() {
        stop_ = true;
        thread_.join();
    }
    CameraFollower(const CameraFollower&) = delete;
    CameraFollower& operator=(const CameraFollower&) = delete;

    [[nodiscard]] int frames() const { return frames_; }
    [[nodiscard]] int answers(hal::Error error) const { return answers_.at(Index(error)); }
    [[nodiscard]] int refusals(hal::Error error) const { return refusals_.at(Index(error)); }
    /// Longest time from one frame to the next.
    [[nodiscard]] Milliseconds longest_silence() const { return Milliseconds(silence_ms_); }
    [[nodiscard]] bool in_order() const { return in_order_; }
    /// In WaitFrame and Reopen.
    [[nodiscard]] std::uint64_t heap_calls() const { return heap_calls_; }

    /// False if it does not come true in time.
    static bool Await(const std::function<bool()>& condition,
                      Milliseconds timeout = Milliseconds(5000)) {
        const auto end = Clock::now() + timeout;
        while (!condition() && Clock::now() < end) std::this_thread::sleep_for(Milliseconds(5));
        return condition();
    }
    bool AwaitFrames(int more) const {
        const int from = frames_;
        return Await([this, from, more] { return frames_ >= from + more; });
    }

 private:
    static std::size_t Index(hal::Error error) { return static_cast<std::size_t>(error); }

    void Work() {
        Milliseconds back_off{100};
        while (!stop_) {
            if (Take() != hal::Error::kDisconnected) {
                back_off = Milliseconds(100);
                continue;
            }
            std::this_thread::sleep_for(back_off);
            Reopen();
            back_off = std::min(back_off * 2, Milliseconds(500));
        }
    }

    hal::Error Take() {
        const std::uint64_t before = HeapCallsOfThisThread();
        const auto frame = camera_.WaitFrame(Milliseconds(50));
        heap_calls_ += HeapCallsOfThisThread() - before;
        if (frame) {
            Note(frame.value().view().header);
            return hal::Error::kTimeout;
        }
        ++answers_.at(Index(frame.error()));
        return frame.error();
    }

    void Reopen() {
        const std::uint64_t before = HeapCallsOfThisThread();
        const auto reopened = camera_.Reopen();
        heap_calls_ += HeapCallsOfThisThread() - before;
        if (!reopened) ++refusals_.at(Index(reopened.error()));
    }

    void Note(const hal::FrameHeader& header) {
        const auto now = Clock::now();
        const auto silence = std::chrono::duration_cast<Milliseconds>(now - heard_at_).count();
        if (frames_ > 0) silence_ms_ = std::max<std::int64_t>(silence_ms_, silence);
        if (frames_ > 0 && header.sequence <= sequence_) in_order_ = false;
        sequence_ = header.sequence;
        heard_at_ = now;
        ++frames_;
    }

    hal::Camera& camera_;
    Clock::time_point heard_at_;
    std::uint32_t sequence_ = 0;
    std::array<std::atomic<int>, 8> answers_{};
    std::array<std::atomic<int>, 8> refusals_{};
    std::atomic<int> frames_ = 0;
    std::atomic<std::int64_t> silence_ms_ = 0;
    std::atomic<std::uint64_t> heap_calls_ = 0;
    std::atomic<bool> in_order_ = true;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

}  // namespace hitchview::tests
