#pragma once

#include <array>
#include <filesystem>
#include <memory>

#include "app/frame_set.hpp"
#include "app/frame_tap.hpp"
#include "app/recorder.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// Records the frame sets of a bench as `run` records those of live cameras.
class BenchRecording {
 public:
    /// `first`: a set of the bench. Everything referred to must outlive this. Stops the program
    /// where the folder cannot be written.
    BenchRecording(const std::filesystem::path& folder, const FrameSet& first, hal::Clock& clock);

    /// The set to go on with.
    FrameSet Tap(FrameSet set);
    /// Into the recording.
    [[nodiscard]] hal::Publisher& publisher() { return *publisher_; }
    /// What was recorded. Once.
    RecordingSummary Finish();

 private:
    EventQueue events_;
    algo::PerUnit<std::array<FrameTap, algo::kMaxCameras>> taps_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<hal::Publisher> publisher_;
};

}  // namespace hitchview::app
