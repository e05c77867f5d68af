#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/avi_file.hpp"
#include "hal/blocking_ring.hpp"
#include "hal/frame_pool.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

struct VideoWriterOptions {
    std::string name;       ///< its thread is called `out-<name>`
    double rate_hz = 30;    ///< nominal frames per second, as the file will state
    int quality = 95;       ///< of JPEG, 4:2:0. [1, 100]
    int queued_frames = 4;  ///< taken at construction. [1, 64]
};

/// Motion JPEG .avi of I420 full-range frames, compressed from their planes: black stays black. One
/// frame for each Append; nothing is lost or repeated, a caller faster than the disk waits.
/// Thread: its own compresses and writes; one other calls Append and Finish.
class VideoWriter {
 public:
    /// Takes all memory that Append needs.
    static hal::Checked<std::unique_ptr<VideoWriter>> Open(const std::string& path,
                                                           const hal::FrameFormat& format,
                                                           const VideoWriterOptions& options);
    ~VideoWriter();

    /// Copies the frame; waits while the queue is full. kFailed: the disk refused an earlier frame;
    /// Finish says why.
    hal::Result<hal::Done> Append(const hal::FrameView& frame);

    /// Waits until everything is in the file, and closes it. Once.
    hal::Checked<hal::Done> Finish();

 private:
    struct DestroyJpeg {
        void operator()(void* handle) const;
    };

    VideoWriter(const std::string& path, const hal::FrameFormat& format,
                const VideoWriterOptions& options);
    void WriteAll();
    void WriteOne(const hal::FramePool::Slot& slot);
    void Refuse(const std::string& reason);

    std::string path_;
    VideoWriterOptions options_;
    hal::FramePool pool_;
    hal::BlockingRing<hal::FramePool::Slot, 64> free_;
    hal::BlockingRing<hal::FramePool::Slot, 64> filled_;
    std::unique_ptr<void, DestroyJpeg> compressor_;
    std::vector<std::uint8_t> jpeg_;
    std::unique_ptr<AviFile> file_;
    std::atomic<bool> refused_{false};
    std::string refusal_;  ///< written by the thread, read after it ended
    std::thread thread_;
};

}  // namespace hitchview::app
