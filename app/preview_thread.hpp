#pragma once

#include <array>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "app/config.hpp"
#include "app/frame_set.hpp"
#include "app/jpeg_encoder.hpp"
#include "app/preview_reduction.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

struct PreviewOptions {
    algo::PerUnit<std::vector<std::string>> cameras;  ///< names, as in the rig file
    hal::Instant period{};                            ///< between two sets of previews, at least
};

/// Makes previews of frame sets that were shown, on a thread of its own (`preview`). Holds one set
/// at most, and only until it is reduced; nobody waits for it. Memory is taken at construction.
class PreviewThread {
 public:
    explicit PreviewThread(const PreviewOptions& options);
    ~PreviewThread();
    PreviewThread(const PreviewThread&) = delete;
    PreviewThread& operator=(const PreviewThread&) = delete;

    /// Whether a set offered now would be taken. Thread: pipeline.
    [[nodiscard]] bool IsDue(hal::Instant now) const {
        return state_.load(std::memory_order_acquire) == kIdle && now >= next_at_;
    }
    /// After IsDue. `start`: moment of the clock that is moment 0 of the set. Same thread.
    void Give(FrameSet&& set, hal::Instant start, hal::Instant now);

    /// The previews of the newest set, one for each camera that gave a frame; empty when there are
    /// none. Borrowed until Done. Thread: publisher.
    std::span<const hal::PreviewImage> Take() const;
    /// After a Take that gave something.
    void Done();

    /// Gives the set back and ends the thread. Before the cameras go. Once.
    void Finish();

 private:
    enum State : int { kIdle, kGiven, kMade, kStopped };

    void Work();
    void MakePreviews();
    void MakePreview(const hal::FrameLease& lease, std::size_t camera);

    PreviewOptions options_;
    std::vector<std::string> channels_;  // tractor first
    std::vector<std::uint8_t> reduced_;
    JpegEncoder encoder_;
    std::vector<std::vector<std::uint8_t>> jpegs_;
    std::array<hal::PreviewImage, kMaxCameras> made_{};
    std::size_t made_count_ = 0;
    FrameSet set_;
    hal::Instant start_{};
    hal::Instant next_at_{};  // the pipeline's
    std::atomic<int> state_{kIdle};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace hitchview::app
