#pragma once

#include <atomic>
#include <memory>

#include "app/board.hpp"
#include "app/recorder.hpp"
#include "app/run_loop.hpp"

namespace hitchview::app {

/// The recorder of a run as its rig file says; null where nothing is recorded. The board was opened
/// to be recorded and must outlive it. The error says what is wrong with the folder or the rig.
hal::Checked<std::unique_ptr<Recorder>> OpenRecorder(const RigConfig& config,
                                                     const RunOptions& options,
                                                     const RunSummary& run, Board& board);

/// A publisher into the recording.
hal::Checked<std::unique_ptr<hal::Publisher>> OpenRecordingPublisher(const PublishConfig& config,
                                                                     const hal::Clock& clock,
                                                                     Recorder& recorder);

}  // namespace hitchview::app
