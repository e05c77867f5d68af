#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/frame_jpeg.hpp"
#include "app/frame_tap.hpp"
#include "app/record_intake.hpp"

namespace hitchview::app {

struct FrameRecorderOptions {
    int threads = 2;          ///< [1, 8]
    bool raw = false;         ///< frames as they came; otherwise JPEG
    int quality = 85;         ///< of the JPEG. [30, 100]
    std::uint32_t every = 1;  ///< each so many-th frame of a camera; they are numbered anew. >= 1
};

/// One camera that is recorded.
struct RecordedCamera {
    std::string name;
    std::string channel;
    hal::FrameFormat format{};
    FrameTap* tap = nullptr;
};

struct FrameCounts {
    std::string name;
    std::uint64_t recorded = 0;
    std::uint64_t dropped = 0;
};

/// Compresses the cameras' frames for a recording on threads of its own (`record-1` ...) that run
/// when nobody else wants the CPU. Each camera belongs to one of them, so that its frames keep
/// their order. Memory is taken at construction.
class FrameRecorder {
 public:
    /// All that is referred to must outlive it; the cameras until Finish.
    FrameRecorder(std::vector<RecordedCamera> cameras, const FrameRecorderOptions& options,
                  RecordIntake& intake);
    ~FrameRecorder();
    FrameRecorder(const FrameRecorder&) = delete;
    FrameRecorder& operator=(const FrameRecorder&) = delete;

    /// The cameras' frames are recorded from now on.
    void Start();
    /// Records what the cameras gave, gives their frames back and ends the threads. Once.
    void Finish();
    /// Any thread. Takes memory.
    [[nodiscard]] std::vector<FrameCounts> counts() const;

 private:
    struct Channel;
    struct Worker;

    void Work(Worker& worker, int number);
    bool RecordNext(Worker& worker, Channel& channel);
    void Record(Worker& worker, Channel& channel, const hal::FrameView& frame);
    void NoteDrops(Channel& channel);

    FrameRecorderOptions options_;
    RecordIntake& intake_;
    std::vector<std::unique_ptr<Channel>> channels_;
    std::vector<std::unique_ptr<Worker>> workers_;
    std::atomic<bool> stop_{false};
};

}  // namespace hitchview::app
